#!/usr/bin/env bash
# drift_test.sh ETLC CXX FLAG...: the drifts of the generated class know after each episode what
# `etlc run` prints: of a predicate with <=, of one with >= that no monitor reads and
# whose scores tie, and of a monitor that is calibrated as a whole. Samples are missing. Episodes
# that are cut short leave nothing, and a reboot changes nothing.
. "$(dirname "$0")/../box.bash"
etlc=$1 cxx=$2
shift 2

cat >road.etl <<'END'
spec road;
rate 10 Hz;
input z : f32[2];
input grip : f32 in [0, 9];
target road = [[1, 0], [0.75, 0], [0.5, 0], [0.25, 0], [0, 0]];
predicate usual = min l2(z, road) <= calibrated(normal, alpha = 0.2);
predicate firm = grip >= calibrated(normal, alpha = 0.2);
predicate near = min l2(z, road) <= 0.12;
monitor on_road = G usual;
monitor calm = G !held[2 steps] !near calibrated(normal, alpha = 0.2);
drift moved = of usual, level = 0.01;
drift loose = of firm, level = 0.01;
drift shaken = of calm, level = 0.01;
END
cat >drives.awk <<'END'
function r() { seed = (seed * 16807) % 2147483647; return seed / 2147483647 }
BEGIN { seed = from + 7
  for (e = from; e < from + n; e++) { f = sprintf("%s/%03d.csv", dir, e)
    print "z[0],z[1],grip" > f
    for (t = 0; t < 20; t++) {
      x = (e >= worse ? 0.1 : 0) + 1 - t / 20 + 0.3 * (r() - 0.5)
      gone = r() < 0.05
      y = gone ? "," : x "," 0.3 * (r() - 0.5)
      print y "," (r() < 0.05 ? "" : 3 + int(3 * r() * r())) > f }
    close(f) } }
END
mkdir known others later
awk -v n=30 -v dir=known -v from=0 -v worse=999 -f drives.awk
awk -v n=30 -v dir=others -v from=100 -v worse=999 -f drives.awk
awk -v n=120 -v dir=later -v from=200 -v worse=260 -f drives.awk
"$etlc" calibrate road.etl --data known -o predicates.json >report.txt
"$etlc" calibrate road.etl --data others --thresholds predicates.json -o road.thresholds.json \
  >report.txt
"$etlc" road.etl -o road.hpp

cat >road.cpp <<'END'
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "road.hpp"

namespace {

std::string next(const char*& at) {
    const char* begin = at;
    at += std::strcspn(at, ",\n");
    const std::string cell(begin, at);
    if (*at == ',') ++at;
    return cell;
}

/// Steps through an episode, or through its first steps.
void drive(road::Monitor& monitor, const char* path, int most = 1000) {
    std::FILE* file = std::fopen(path, "r");
    char line[256];
    if (!file || !std::fgets(line, sizeof line, file)) std::exit(1);
    while (most-- > 0 && std::fgets(line, sizeof line, file)) {
        const char* at = line;
        const std::string x = next(at), y = next(at), grip = next(at);
        const float z[2] = {std::strtof(x.c_str(), nullptr), std::strtof(y.c_str(), nullptr)};
        road::Inputs in;
        if (!x.empty()) in.z = z;
        if (!grip.empty()) in.grip = std::strtof(grip.c_str(), nullptr);
        monitor.step(in);
    }
    std::fclose(file);
}

void print(const char* name, bool alarm, const etlmon::DriftState& state, float limit) {
    std::printf("drift %s: %s after %u episode%s, wealth %.3g of %.3g\n", name,
                alarm ? "ALARM" : "no alarm", state.episodes(), state.episodes() == 1 ? "" : "s",
                static_cast<double>(state.wealth()), static_cast<double>(limit));
}

}  // namespace

int main(int argc, char** argv) {
    static road::Monitor monitor;
    for (int i = 1; i < argc; ++i) {
        drive(monitor, argv[argc - i], 7);  // cut short: a reset alone counts nothing
        monitor.reset();
        drive(monitor, argv[i]);
        monitor.end_episode();
        monitor.reset();
        std::printf("%s\n", argv[i]);
        print("moved", monitor.alarm_moved(), monitor.drift_moved(), 100);
        print("loose", monitor.alarm_loose(), monitor.drift_loose(), 100);
        print("shaken", monitor.alarm_shaken(), monitor.drift_shaken(), 100);
        if (i % 10 != 0) continue;
        road::Monitor fresh;  // a reboot
        if (!fresh.set_drift_moved(monitor.drift_moved()) ||
            !fresh.set_drift_loose(monitor.drift_loose()) ||
            !fresh.set_drift_shaken(monitor.drift_shaken()))
            return 2;
        if (fresh.set_drift_moved(monitor.drift_loose())) return 3;  // of another drift
        monitor = fresh;
    }
    return 0;
}
END
"$cxx" -std=c++17 -Wall -Wextra -Wconversion -Wshadow -Wpedantic -Werror "$@" -I . -I "$runtime" \
  road.cpp -o road
./road later/*.csv >class.txt
"$etlc" run road.etl --data later --summary -o rows.csv | grep '^drift\|^later' >run.txt
diff run.txt class.txt || fail "the class and etlc run differ"
[ "$(grep -c '^drift' run.txt)" = 360 ] || fail "not three lines an episode"
tail -3 run.txt | grep -q 'moved: ALARM after' || fail "a shift is not found"
tail -3 run.txt | grep -q 'loose: no alarm after 120' || fail "a drift of nothing"

# --changes says it once, below the episode.
"$etlc" run road.etl --data later --changes -o rows.csv | grep -B 1 '^drift moved' >changes.txt
[ "$(grep -c '^drift moved' changes.txt)" -ge 1 ] || fail "no line where the alarm is raised"

# A build under -ffast-math raises the same alarms.
"$cxx" -std=c++17 -O2 -ffast-math -I . -I "$runtime" road.cpp -o fast
./fast later/*.csv | sed 's/, wealth.*//' | diff - <(sed 's/, wealth.*//' class.txt) ||
  fail "-ffast-math changes what is said"

for how in "--values boolean" "--targets-as i8" --retargetable; do
  # shellcheck disable=SC2086
  ! "$etlc" road.etl $how -o other.hpp 2>message || fail "$how is taken"
  grep -q "E0658\|E0704\|E0655\|E0703" message || fail "$how: $(cat message)"
done
