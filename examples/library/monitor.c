/* Steps the monitors of a spec that is read when the program starts, in C.
 *
 * monitor SPEC.etl: a robot visits the shelf and returns to its dock too late. Prints what the
 * monitors say, and why the alarm. */
#include <etlc.h>
#include <stdio.h>
#include <stdlib.h>

enum { kSteps = 14, kDimension = 4 };

static void check(etlc_status status) {
  if (status == ETLC_OK) return;
  fprintf(stderr, "%s\n", etlc_message());
  exit(1);
}

/* What the camera sees: from the shelf to the dock. */
static void look(int step, float *z) {
  static const float shelf[kDimension] = {0.1f, 0.9f, 0.3f, 0.0f};
  static const float dock[kDimension] = {0.9f, 0.1f, 0.0f, 0.2f};
  const float way = (float)step / (kSteps - 1);
  for (int i = 0; i < kDimension; ++i) z[i] = shelf[i] + way * (dock[i] - shelf[i]);
}

static const char *status_of(etlc_verdict verdict) {
  if ((verdict.status & ETLC_DECIDED) == 0) return "undecided";
  if ((verdict.status & ETLC_SATISFIED) != 0) return "satisfied";
  return (verdict.status & ETLC_VIOLATED) != 0 ? "violated" : "unknown";
}

int main(int argc, char **argv) {
  if (argc != 2) {
    fprintf(stderr, "usage: monitor SPEC.etl\n");
    return 2;
  }
  etlc_options options = ETLC_OPTIONS;
  options.path = argv[1];
  options.history = kSteps;
  etlc_session session;
  check(etlc_open(&options, &session));

  uint32_t z_at, charge_at, returns;
  check(etlc_find(session, ETLC_INPUTS, "z", &z_at));
  check(etlc_find(session, ETLC_INPUTS, "charge", &charge_at));
  check(etlc_find(session, ETLC_MONITORS, "returns", &returns));
  etlc_description spec = {.struct_size = sizeof spec};
  check(etlc_describe(session, &spec));
  printf("%s: %u inputs, %u monitors, %llu bytes of state\n", spec.name, spec.inputs,
         spec.monitors, (unsigned long long)spec.state_bytes);

  float z[kDimension], charge;
  etlc_sample samples[2];
  samples[z_at] = (etlc_sample){z, kDimension, ETLC_F32};
  samples[charge_at] = (etlc_sample){&charge, 1, ETLC_F32};
  etlc_verdict *const verdicts = malloc(spec.monitors * sizeof *verdicts);
  if (verdicts == NULL) return 1;

  for (int step = 0; step < kSteps; ++step) {
    look(step, z);
    charge = 0.4f - 0.05f * (float)step;
    check(etlc_step(session, samples, 2, verdicts, spec.monitors));
    printf("step %2d:", step);
    for (uint32_t m = 0; m < spec.monitors; ++m) {
      etlc_monitor monitor = {.struct_size = sizeof monitor};
      check(etlc_describe_monitor(session, m, &monitor));
      printf(" %s %s%s", monitor.name, status_of(verdicts[m]),
             etlc_is_alarm(verdicts[m]) ? "!" : "");
    }
    printf("\n");
    if (etlc_is_alarm(verdicts[returns])) {
      const char *why;
      check(etlc_explain(session, returns, ETLC_TEXT, &why));
      printf("%s", why);
      break;
    }
  }
  free(verdicts);
  check(etlc_close(session));
  return 0;
}
