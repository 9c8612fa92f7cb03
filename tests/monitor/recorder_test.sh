#!/usr/bin/env bash
# recorder_test.sh ETLC VALUES CXX FLAG...: steps a class with a flight recorder over a trace; `etlc
# incident` prints the distances and verdicts that `etlc run` has for the same steps. The incident's
# trace and spec give the same distances again. Damaged files are refused.
. "$(dirname "$0")/../box.bash"
etlc=$1 values=$2 cxx=$3
shift 3

cat >drive.etl <<'END'
spec drive;
rate 10 Hz;
input z : f32[3];
input x : f32;
input held : bool;
input armed : bool hold 2;
target goal = [[1, 0, 0], [0, 1, 0]];
target wall = [[0, 0, 1]];
predicate at_goal = min l2(z, goal) <= 0.4;
predicate at_wall = l2(z, wall) <= 0.35;
predicate fast = x * x > 0.81;
monitor safe = G !at_wall;
monitor calm = G (x <= 0.97 || held);
monitor reach = F (at_goal && armed);
sliding monitor slow = G[0, 0.2 s] !fast;
repeating monitor again = F[0, 0.3 s] (at_goal && x <= 0.97);
END
"$etlc" drive.etl --values "$values" --recorder 0.45s,3,6 -o drive.hpp
grep -q 'etlmon::Recorder<etlmon::RecorderRow<6, 2, 5>, 5, 3, 6>' drive.hpp  # 0.45 s are 5 steps

awk 'BEGIN {
  srand(5)
  print "z[0],z[1],z[2],x,held,armed"
  for (step = 0; step < 120; ++step) {
    print gap(rand(), 9) "," rand() "," rand() "," gap(rand(), 8) "," gap(int(2 * rand()), 7) "," \
          gap(int(2 * rand()), 3)
  }
}
function gap(x, n) { return rand() < 1 / n ? "" : x }' >drive.csv

cat >drive.cpp <<'END'
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "drive.hpp"

namespace {

/// The next cell of a line; empty: missing.
std::string next(const char*& at) {
    const char* begin = at;
    at += std::strcspn(at, ",\n");
    const std::string cell(begin, at);
    if (*at == ',') ++at;
    return cell;
}

}  // namespace

int main() {
    static drive::Monitor monitor;
    char line[256];
    if (!std::fgets(line, sizeof line, stdin)) return 1;
    while (std::fgets(line, sizeof line, stdin)) {
        const char* at = line;
        float z[3];
        bool there = true;
        for (float& element : z) {
            const std::string cell = next(at);
            there = there && !cell.empty();
            element = std::strtof(cell.c_str(), nullptr);
        }
        drive::Inputs in;
        if (there) in.z = z;
        if (const std::string x = next(at); !x.empty()) in.x = std::strtof(x.c_str(), nullptr);
        if (const std::string held = next(at); !held.empty()) in.held = held == "1";
        if (const std::string armed = next(at); !armed.empty()) in.armed = armed == "1";
        monitor.step(in);
    }
    monitor.reset();  // the episode is over: no incident waits any more
    std::printf("%u %u\n", monitor.incidents(), monitor.lost_incidents());
    for (uint32_t n = 0; n < monitor.incidents(); ++n) {
        std::FILE* file = std::fopen(("incident" + std::to_string(n)).c_str(), "wb");
        size_t bytes = 0;
        monitor.write_incident(n, [&](const uint8_t* data, size_t size) {
            std::fwrite(data, 1, size, file);
            bytes += size;
        });
        std::fclose(file);
        if (bytes > drive::Monitor::kIncidentBytes) return 2;
    }
    return 0;
}
END
"$cxx" -std=c++17 -Wall -Wextra -Wconversion -Wshadow -Wpedantic -Werror "$@" -I . -I "$runtime" \
  drive.cpp -o drive
read -r incidents lost < <(./drive <drive.csv)
[ "$incidents" = 6 ] && [ "$lost" -gt 0 ] || fail "$incidents incidents, $lost lost"

# The output of `etlc run` for each step, in the form of an incident without its nearest rows.
"$etlc" run drive.etl --values "$values" --trace drive.csv --distances >run.csv
awk -F, '
  BEGIN { final["violated"] = "alarm"; final["satisfied"] = "fulfilled" }
  NR == 1 { next }
  { step = $1; word[$2] = $7 && $6 in final ? final[$6] : $6
    distances[step] = $9 "," $10 "," $11 "," $12 "," $13
    verdicts[step] = word["safe"] "," word["calm"] "," word["reach"] "," word["slow"] \
                     "," word["again"] }
  END { for (s = 0; s <= step; ++s) print s "," distances[s] "," verdicts[s] }' run.csv >expected
for n in 0 1 2 3 4 5; do
  read_it() { "$etlc" incident "incident$n" --spec drive.etl --values "$values" "$@"; }
  read_it --format csv >incident.csv
  cut -d, -f1-3,5,7,8,11-15 incident.csv | tail -n +2 >found
  first=$(head -1 found | cut -d, -f1)
  last=$(tail -1 found | cut -d, -f1)
  # A class of truth values measures only what it needs, etlc run everything.
  sed -n "$((first + 1)),$((last + 1))p" expected | paste -d, - found | awk -F, '
    { for (c = 1; c <= 11; ++c) if ($(c + 11) != "unasked" && $c != $(c + 11)) bad = 1 }
    END { exit bad }' || fail "incident $n is not what etlc run says"
  ! grep -q unasked found || [ "$values" = boolean ] || fail "incident $n did not ask for all"
  alarm=$(awk -F, 'NR > 1 && $16 != "" { print $1 }' incident.csv)
  grep -qx "$first\|$((first + 5))" <<<"$alarm" || fail "incident $n has its alarm elsewhere"
  read_it | grep -q "^incident $n of drive, episode 0: alarm of " || fail "no table"

  # The same distances, from a spec with distances as inputs.
  read_it --format trace >again.csv
  read_it --format spec >again.etl
  "$etlc" run again.etl --trace again.csv --distances 2>warnings |
    awk -F, 'NR > 1 && $2 == "safe" { print $10 "," $11 "," $12 "," $13 }' >again
  cut -d, -f3-6 found | sed 's/unasked//g' | diff - again ||
    fail "the trace of incident $n has other distances"
done

# Cut, extended, changed, from another spec.
refused() {
  ! "$etlc" incident damaged --spec "${2:-drive.etl}" --values "$values" >out 2>message ||
    fail "$1 is taken"
  [ ! -s out ] && grep -q "$1" message || fail "expected $1: $(cat message)"
}
head -c 200 incident0 >damaged; refused E0832
{ cat incident0; echo; } >damaged; refused E0832
size=$(wc -c <incident0)
for at in 20 70 99 150 $((size - 20)) $((size - 1)); do
  cp incident0 damaged
  byte=$(od -An -tu1 -j "$at" -N1 incident0)
  printf "\\$(printf %03o $((byte ^ 16)))" | dd of=damaged bs=1 seek="$at" conv=notrunc 2>/dev/null
  refused E0832
done
cp incident0 damaged
sed 's/0.35/0.36/' drive.etl >other.etl
refused E0833 other.etl

# An adaptive threshold is recorded with its value at each step.
"$etlc" "$here/../spec/ok/adaptive.etl" --values "$values" --recorder 4,0,1 -o adaptive.hpp
cat >adaptive.cpp <<'END'
#include <cstdio>

#include "adaptive.hpp"

int main() {
    static adaptive::Monitor monitor;
    const float samples[] = {0.9f, 0.95f};
    for (const float x : samples) {
        adaptive::Inputs in;
        in.x = x;
        monitor.step(in);
        monitor.observe_low(monitor.distance_low(), true);  // a hit at first: 1 becomes 0.9375
    }
    monitor.close_incidents();
    const bool written = monitor.write_incident(0, [](const uint8_t* data, size_t size) {
        std::fwrite(data, 1, size, stdout);
    });
    return written ? 0 : 1;
}
END
"$cxx" -std=c++17 -Wall -Wextra -Werror "$@" -I . -I "$runtime" adaptive.cpp -o adaptive
./adaptive >learnt
"$etlc" incident learnt --spec "$here/../spec/ok/adaptive.etl" --values "$values" --format csv |
  cut -d, -f1-3,8 >found
printf '%s\n' step,distance_low,threshold_low,alarm 0,0.899999976,1, 1,0.949999988,0.9375,both |
  diff - found || fail "an adaptive threshold is not what it was"

# For a contrast the nearest row of each set is known, as for a single distance.
cat >contrast.etl <<'END'
spec contrast;
input z : f32[2];
target hand = [[0, 0], [2, 0], [0, 2]];
target wall = [[3, 3], [1, 1], [-3, 1]];
predicate at_hand = min l2(z, hand) <= 0.5;
predicate at_wall = min l2(z, wall) <= 0.5;
predicate closer = min l2(z, hand) - min l2(z, wall) <= 0;
monitor apart = G !closer;
sliding monitor hand_now = at_hand;
sliding monitor wall_now = at_wall;
sliding monitor closer_now = closer;
END
"$etlc" contrast.etl --values "$values" --recorder 2,2,1 -o contrast.hpp
cat >contrast.cpp <<'END'
#include <cstdio>

#include "contrast.hpp"

int main() {
    static contrast::Monitor monitor;
    const float samples[][2] = {{1.2f, 1.3f}, {2.5f, 2.75f}, {0.1f, 1.5f}, {-3, 0.5f}, {1.75f, 0}};
    uint32_t sum = 0;
    for (const auto& z : samples) {
        contrast::Inputs in;
        in.z = z;
        monitor.step(in);
        if (monitor.nearest_closer_hand() != monitor.nearest_at_hand()) return 1;
        if (monitor.nearest_closer_wall() != monitor.nearest_at_wall()) return 2;
        sum += monitor.nearest_closer_hand() + monitor.nearest_closer_wall();
    }
    if (sum == 0) return 3;
    monitor.close_incidents();
    const bool written = monitor.write_incident(0, [](const uint8_t* data, size_t size) {
        std::fwrite(data, 1, size, stdout);
    });
    return written ? 0 : 4;
}
END
"$cxx" -std=c++17 -Wall -Wextra -Werror "$@" -I . -I "$runtime" contrast.cpp -o contrast
./contrast >leaning
"$etlc" incident leaning --spec contrast.etl --values "$values" --format csv >contrast.csv
head -1 contrast.csv | grep -q ',distance_closer,nearest_closer_hand,nearest_closer_wall,' ||
  fail "an incident lacks the rows of a contrast: $(head -1 contrast.csv)"
awk -F, 'NR > 1 && ($3 != $7 || $5 != $8) { bad = 1 } END { exit bad || NR != 4 }' contrast.csv ||
  fail "the rows of a contrast are others than those of its distances"
