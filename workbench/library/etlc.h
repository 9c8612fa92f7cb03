/* libetlc: the monitors of a spec, stepped by a program that was not compiled with them.
 *
 * Takes: a spec, as text or as a file, with its thresholds and fitted entries. Gives: the verdicts
 * of the generated class, bit for bit, and the explanations of `etlc explain`. Keeps true:
 * - A call that fails changes nothing and returns a status; etlc_message() has the reason. The
 *   library prints nothing, throws nothing and does not abort.
 * - Sessions are independent. A session is used by one thread at a time; a call during another call
 *   of the same session is refused with ETLC_BUSY.
 * - After etlc_open(), functions allocate memory only where their comment says so.
 *
 * docs/c_interface.md has an example of every function. C99, and C++. */
#ifndef ETLC_H
#define ETLC_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define ETLC_EXPORT __attribute__((visibility("default")))
#else
#define ETLC_EXPORT
#endif

/* The version of this header. A library accepts programs of its own and of earlier versions. */
#define ETLC_API_VERSION 6u

/* ---- errors --------------------------------------------------------------------------------- */

typedef int32_t etlc_status;
enum {
  ETLC_OK = 0,
  ETLC_REFUSED = 1,        /* the spec is wrong: etlc_message() has its diagnostics */
  ETLC_NULL_POINTER = 2,   /* a pointer must not be null */
  ETLC_NO_SESSION = 3,     /* the session is closed, or was never opened */
  ETLC_BUSY = 4,           /* another thread is in a call of the same session */
  ETLC_WRONG_VERSION = 5,  /* a struct_size or api_version that this library does not know */
  ETLC_WRONG_NUMBER = 6,   /* wrong number of samples, elements or verdicts */
  ETLC_WRONG_TYPE = 7,     /* wrong type of a sample's elements */
  ETLC_WRONG_VALUE = 8,    /* wrong value of an option, a bool, a distance */
  ETLC_NO_SUCH = 9,        /* no such index or name */
  ETLC_NOT_KEPT = 10,      /* etlc_open() was not asked to keep it */
  ETLC_UNDECIDED = 11,     /* the monitor has no verdict yet */
  ETLC_ENDED = 12,         /* the episode has ended: etlc_reset() begins a new one */
  ETLC_OUT_OF_MEMORY = 13,
  ETLC_INTERNAL = 14 /* an internal error */
};

/* Returns why the last call of this thread failed: one line, or the diagnostics of the spec as etlc
 * prints them. Empty where it succeeded. Valid until this thread's next call. Never null. */
ETLC_EXPORT const char *etlc_message(void);

/* Returns the diagnostics of that call as `etlc --diagnostics json` prints them: {"diagnostics":
 * [...]}. After a successful etlc_open(), its warnings. */
ETLC_EXPORT const char *etlc_message_json(void);

/* Returns the version of the library: "0.5.0". */
ETLC_EXPORT const char *etlc_version(void);

/* ---- opening -------------------------------------------------------------------------------- */

/* An open spec; 0 is none. Numbers are never reused, so a closed session stays closed. */
typedef uint64_t etlc_session;

enum { ETLC_ROBUSTNESS = 0, ETLC_BOOLEAN = 1 };           /* values that monitors compute */
enum { ETLC_AS_F32 = 0, ETLC_AS_F16 = 1, ETLC_AS_I8 = 2 }; /* storage of target sets */

/* The options of `etlc run`. Begin with `etlc_options options = ETLC_OPTIONS;`. */
typedef struct etlc_options {
  uint32_t struct_size; /* sizeof(etlc_options) */
  uint32_t api_version; /* ETLC_API_VERSION */
  /* The path of the spec. With `text` it is not read and may be null; it still names the spec in
   * messages, and locates the files beside it and those that the spec loads. */
  const char *path;
  const char *text;             /* the spec; null: it is read from `path` */
  const char *thresholds;       /* a file; null: SPEC.thresholds.json beside the spec */
  const char *fitted;           /* a file; null: SPEC.fitted.npz beside the spec */
  const char *const *settings;  /* values of constants, each "NAME=VALUE" */
  size_t setting_count;         /* at most 10000 */
  uint32_t values;     /* ETLC_ROBUSTNESS or ETLC_BOOLEAN */
  uint32_t targets_as; /* ETLC_AS_F32, ETLC_AS_F16 or ETLC_AS_I8 */
  uint32_t lets;       /* 1: etlc_let() returns the lets at each step */
  uint32_t reserved;   /* 0 */
  uint64_t max_state;  /* limits of the plan; 0: those of etlc */
  uint64_t max_code;
  uint64_t max_work;
  uint64_t history; /* steps that etlc_explain() can look back at; 0: none */
  /* From version 2 on. BEFORE,AFTER,INCIDENTS: the steps to record around each alarm, and the
   * number of alarms, such as "2s,1s,4" or "40,20,4"; null: none. */
  const char *recorder;
  const char *embedded; /* from version 5 on: a file; null: SPEC.embedded.npz beside the spec */
} etlc_options;

#define ETLC_OPTIONS \
  {sizeof(etlc_options), ETLC_API_VERSION, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}

/* Compiles the spec and opens a session before its first step. ETLC_REFUSED where it does not
 * compile. Several threads may call it at once. Allocates memory. */
ETLC_EXPORT etlc_status etlc_open(const etlc_options *options, etlc_session *session);

/* Closes a session; all pointers that it returned become invalid. */
ETLC_EXPORT etlc_status etlc_close(etlc_session session);

/* ---- the spec ------------------------------------------------------------------------------- */

/* Names and texts are valid until etlc_close(). The caller sets struct_size of every struct. */
typedef struct etlc_description {
  uint32_t struct_size;
  uint32_t inputs;     /* each takes a sample at every step */
  uint32_t monitors;   /* each gives a verdict at every step */
  uint32_t predicates; /* named ones first */
  uint32_t lets;       /* lets that etlc_let() can return */
  uint32_t horizon;    /* largest delay of a sliding monitor, in steps */
  double step_seconds; /* 0: the spec has no rate */
  uint64_t state_bytes;
  uint64_t spec_hash; /* XXH64, as in the generated class */
  uint64_t data_hash;
  uint64_t thresholds_hash;
  const char *name;
  const char *warnings; /* as etlc prints them; empty: none */
} etlc_description;

ETLC_EXPORT etlc_status etlc_describe(etlc_session session, etlc_description *description);

/* The elements of a sample. */
enum {
  ETLC_F32 = 0,  /* float */
  ETLC_BOOL = 1, /* uint8_t, 0 or 1 */
  ETLC_F16 = 2,  /* uint16_t, the bits of an IEEE half */
  ETLC_I8 = 3    /* int8_t */
};

typedef struct etlc_input {
  uint32_t struct_size;
  uint32_t type;      /* ETLC_F32, ... */
  uint32_t dimension; /* number of elements; 1 for a scalar or a bool */
  uint32_t hold;      /* successive missing samples that the last sample replaces */
  float low;          /* range of a scalar; -inf, inf: none */
  float high;
  float scale;      /* ETLC_I8: the value of 1 */
  uint32_t is_embedding;
  uint32_t is_used;     /* 0: no monitor uses it, and etlc_step() ignores it */
  uint32_t stale_after; /* equal samples in a row that count; 0: all of them */
  const char *name;
} etlc_input;

ETLC_EXPORT etlc_status etlc_describe_input(etlc_session session, uint32_t input,
                                            etlc_input *description);

enum { ETLC_NEVER = 0, ETLC_ON_REQUEST = 1, ETLC_WHEN_FINAL = 2 }; /* when a monitor restarts */

typedef struct etlc_monitor {
  uint32_t struct_size;
  uint32_t is_sliding;
  uint32_t restarts; /* ETLC_NEVER, ... */
  uint32_t horizon;  /* delay of a sliding monitor, in steps */
  const char *name;
  const char *formula;
} etlc_monitor;

ETLC_EXPORT etlc_status etlc_describe_monitor(etlc_session session, uint32_t monitor,
                                              etlc_monitor *description);

typedef struct etlc_predicate {
  uint32_t struct_size;
  uint32_t is_measured; /* 0: no monitor needs it */
  uint32_t is_adaptive; /* its threshold moves with etlc_observe() */
  uint32_t has_nearest; /* it is a plain distance, which has a nearest row */
  const char *name;     /* what is compared, where it has no name */
  const char *text;     /* "min l2(z, goal) <= 0.25" */
} etlc_predicate;

ETLC_EXPORT etlc_status etlc_describe_predicate(etlc_session session, uint32_t predicate,
                                                etlc_predicate *description);

/* Returns the name of a let, by the index that etlc_let() takes. */
ETLC_EXPORT etlc_status etlc_describe_let(etlc_session session, uint32_t let, const char **name);

enum { ETLC_INPUTS = 0, ETLC_MONITORS = 1, ETLC_PREDICATES = 2, ETLC_LETS = 3 };

/* Finds the index of an input, monitor, predicate or let by its name. */
ETLC_EXPORT etlc_status etlc_find(etlc_session session, uint32_t kind, const char *name,
                                  uint32_t *index);

/* ---- stepping ------------------------------------------------------------------------------- */

/* A sample of an input. Its elements are aligned for their type and only read during the call. */
typedef struct etlc_sample {
  const void *data; /* null: missing */
  uint32_t count;   /* number of elements: the dimension of the input */
  uint32_t type;    /* type of elements: that of the input */
} etlc_sample;

enum { /* bits of a verdict's status */
  ETLC_SATISFIED = 1,
  ETLC_VIOLATED = 2,
  ETLC_DECIDED = 4,
  ETLC_FINAL = 8, /* no continuation changes it between satisfied and violated */
  ETLC_ALARM = ETLC_VIOLATED | ETLC_DECIDED | ETLC_FINAL /* all three: violated for good */
};

/* The verdict of a monitor after a step. All three numbers are NaN where it is not decided. */
typedef struct etlc_verdict {
  float robustness;
  float lower; /* lower bound on the robustness of all continuations */
  float upper; /* upper bound */
  uint32_t status;
} etlc_verdict;

/* Returns whether the monitor is violated for good. */
static inline int etlc_is_alarm(etlc_verdict verdict) {
  return (verdict.status & ETLC_ALARM) == ETLC_ALARM;
}

/* Makes a step. `samples`: one per input, in the order of the spec; a number that is not finite, or
 * out of the range of its input, counts as missing. `verdicts`: room for all monitors. */
ETLC_EXPORT etlc_status etlc_step(etlc_session session, const etlc_sample *samples,
                                  size_t sample_count, etlc_verdict *verdicts,
                                  size_t verdict_count);

/* The samples of an input at successive steps. The elements of a step are contiguous, aligned for
 * their type, and `stride` bytes after those of the previous step. */
typedef struct etlc_column {
  const void *data;       /* null: missing at all steps */
  const uint8_t *present; /* a byte per step, 0: missing; null: present at all steps */
  int64_t stride;
  uint32_t count;
  uint32_t type;
} etlc_column;

/* Makes `steps` steps, like so many calls of etlc_step(). `verdicts`: room for all monitors at step
 * 0, then at step 1, and so on. */
ETLC_EXPORT etlc_status etlc_run(etlc_session session, const etlc_column *columns,
                                 size_t column_count, uint64_t steps, etlc_verdict *verdicts,
                                 size_t verdict_count);

/* Ends the episode. In each call, sliding monitors report one of the remaining `horizon` positions;
 * the others repeat their last verdict. No step may follow. */
ETLC_EXPORT etlc_status etlc_finish(etlc_session session, etlc_verdict *verdicts,
                                    size_t verdict_count);

/* Ends an episode that ended regularly: its scores count for the drifts. Call it after the last
 * step, before etlc_reset(), which alone drops an episode that was cut short. From version 6 on. */
ETLC_EXPORT etlc_status etlc_end_episode(etlc_session session);

/* Begins a new episode. Adaptive thresholds keep their values, drifts the episodes that ended. */
ETLC_EXPORT etlc_status etlc_reset(etlc_session session);

/* Restarts a restartable monitor at the next step. */
ETLC_EXPORT etlc_status etlc_restart(etlc_session session, uint32_t monitor);

/* Passes a label to an adaptive threshold: the predicate's distance on a frame, and whether the
 * predicate is true there. */
ETLC_EXPORT etlc_status etlc_observe(etlc_session session, uint32_t predicate, float distance,
                                     uint32_t truth);

/* ---- after a step --------------------------------------------------------------------------- */

/* Returns the number of steps since the session was opened or reset. */
ETLC_EXPORT etlc_status etlc_steps(etlc_session session, uint64_t *steps);

/* Returns the step that the last verdict of a monitor is about. */
ETLC_EXPORT etlc_status etlc_position(etlc_session session, uint32_t monitor, uint64_t *position);

typedef struct etlc_measured {
  float distance; /* distance or expression; NaN: unknown, or not needed */
  float threshold;
  uint32_t nearest; /* nearest row of the target, for a plain distance */
} etlc_measured;

/* Returns the measurement of a predicate at the last step. */
ETLC_EXPORT etlc_status etlc_measure(etlc_session session, uint32_t predicate,
                                     etlc_measured *measured);

/* Returns the threshold within which a predicate with two thresholds is true; it is false beyond
 * that of etlc_measured. NaN: it has one. From version 5 on. */
ETLC_EXPORT etlc_status etlc_inner_threshold(etlc_session session, uint32_t predicate,
                                             float *threshold);

typedef struct etlc_drift {
  uint32_t struct_size;
  uint32_t is_alarm; /* episodes no longer score like those of calibration */
  uint32_t episodes; /* that ended regularly, up to the alarm */
  float wealth;      /* 1 at first; an alarm where it reaches `limit` */
  float limit;       /* 1 / level */
  uint32_t counts[8]; /* episodes by the cell of their score, the usual ones first */
} etlc_drift;

/* Returns what the drift of that name knows. Save and load it with the session. From version 6
 * on. */
ETLC_EXPORT etlc_status etlc_drifted(etlc_session session, const char *name, etlc_drift *drift);

/* Returns the value of a let at the last step. */
ETLC_EXPORT etlc_status etlc_let(etlc_session session, uint32_t let, etlc_verdict *verdict);

typedef struct etlc_counts {
  uint64_t missing;      /* samples that were missing, not finite or stale */
  uint64_t out_of_range; /* samples of a scalar out of its range */
  uint64_t held;         /* of both, samples that the last one replaced */
} etlc_counts;

/* Counts the samples of an input since the session was opened or reset. */
ETLC_EXPORT etlc_status etlc_count(etlc_session session, uint32_t input, etlc_counts *counts);

enum { ETLC_TEXT = 0, ETLC_JSON = 1 };

/* Explains the last verdict of a monitor, like `etlc explain`. The text is valid until the next
 * call of this function or etlc_close(). Needs `history`; allocates memory; its time is
 * proportional to the episode. */
ETLC_EXPORT etlc_status etlc_explain(etlc_session session, uint32_t monitor, uint32_t format,
                                     const char **text);

/* ---- copies, plans, states ------------------------------------------------------------------ */

/* Opens a copy of a session with its state, incidents and history, or of a batch. The copy goes on
 * by itself; both share the compiled spec. Allocates memory. */
ETLC_EXPORT etlc_status etlc_copy(etlc_session session, etlc_session *copy);

/* The samples of an input in rows of steps: a row is an environment of a batch, or a plan. The
 * elements of a step are contiguous and aligned for their type. */
typedef struct etlc_grid {
  const void *data;       /* null: missing at all steps of all rows */
  const uint8_t *present; /* a byte per row and step, row by row, 0: missing; null: all present */
  int64_t stride;         /* bytes from a row to the next */
  int64_t step_stride;    /* bytes from a step to the next */
  uint32_t count;
  uint32_t type;
} etlc_grid;

/* Gives the verdicts of continuations: each row goes on from the present state, which does not
 * change. A batch has `plans` rows for each of its environments, those of environment 0 first; any
 * other session has `plans` rows; at most 2^32 rows in all. `verdicts`: room for rows x steps x
 * monitors, in this order. `threads`, at most 1024, share the rows; 0 or 1: only this one. History
 * and recorder take no part. Allocates memory. */
ETLC_EXPORT etlc_status etlc_ahead(etlc_session session, const etlc_grid *grids, size_t grid_count,
                                   uint64_t plans, uint64_t steps, uint32_t threads,
                                   etlc_verdict *verdicts, size_t verdict_count);

/* Returns the state of a session or batch as bytes, valid until the next call of this function or
 * etlc_close(). They have the history with them. A session with a recorder is not saved
 * (ETLC_NOT_KEPT). Allocates memory. */
ETLC_EXPORT etlc_status etlc_save(etlc_session session, const void **bytes, size_t *size);

/* Takes a state that etlc_save() returned, with the same version of etlc on a machine with the same
 * byte order, from a session with the same spec, files and options. Others are refused, and so are
 * bytes that were damaged. Allocates memory. */
ETLC_EXPORT etlc_status etlc_load(etlc_session session, const void *bytes, size_t size);

/* ---- batches -------------------------------------------------------------------------------- */

/* A batch steps many environments of one spec in one call. Its environments share nothing but the
 * spec; each has the verdicts that a session of its own would have. A batch is a session too: it
 * has a number, is used by one thread at a time, and describes its spec. */

/* Opens a batch of 1 to 2^32 `environments` with the spec of a session, which may be closed before
 * the batch. All begin before their first step, with the thresholds of etlc_open(). There is no
 * history and no recorder. Allocates memory; ETLC_OUT_OF_MEMORY where there is too little. */
ETLC_EXPORT etlc_status etlc_open_batch(etlc_session session, uint64_t environments,
                                        etlc_session *batch);

/* Makes `steps` steps in all environments. `grids`: one per input, in the order of the spec, with a
 * row per environment. `verdicts`: room for environments x steps x monitors, in this order.
 * `threads`, at most 1024, share the environments; 0 or 1: only this one. With more, allocates
 * memory. */
ETLC_EXPORT etlc_status etlc_run_batch(etlc_session batch, const etlc_grid *grids,
                                       size_t grid_count, uint64_t steps, uint32_t threads,
                                       etlc_verdict *verdicts, size_t verdict_count);

/* These do what the function for a session does, in some environments. `which`: a byte per
 * environment, 0: not in this one; null: in all. */
ETLC_EXPORT etlc_status etlc_reset_batch(etlc_session batch, const uint8_t *which,
                                         uint64_t environments);
ETLC_EXPORT etlc_status etlc_restart_batch(etlc_session batch, uint32_t monitor,
                                           const uint8_t *which, uint64_t environments);
/* `verdicts`: room for environments x monitors; those of the others stay as they are. */
ETLC_EXPORT etlc_status etlc_finish_batch(etlc_session batch, const uint8_t *which,
                                          uint64_t environments, etlc_verdict *verdicts,
                                          size_t verdict_count);

/* Returns the number of steps of each environment since it was opened or reset. */
ETLC_EXPORT etlc_status etlc_steps_batch(etlc_session batch, uint64_t *steps,
                                         uint64_t environments);

/* Returns the measurement of a predicate at the last step of each environment. */
ETLC_EXPORT etlc_status etlc_measure_batch(etlc_session batch, uint32_t predicate,
                                           etlc_measured *measured, uint64_t environments);

/* Opens a copy of one environment as a session, for all that the functions of sessions can do.
 * Allocates memory. */
ETLC_EXPORT etlc_status etlc_copy_environment(etlc_session batch, uint64_t environment,
                                              etlc_session *copy);

/* ---- encoders ------------------------------------------------------------------------------- */

enum { ETLC_REFERENCE_FRAMES = 4 };

/* Compares an encoder with that of calibration. `frame`: of the reference frames that `etlc embed
 * --write-reference` writes, from 0. `embedding`: what the encoder makes of it. `encoder`: its name
 * in the spec; null where the spec has one encoder. `difference` is |z - r| / |r|, where r is what
 * `etlc embed` made of the frame; infinite where z is not finite. Up to 1e-3 is rounding; verdicts
 * mean nothing with another encoder. */
ETLC_EXPORT etlc_status etlc_encoder_difference(etlc_session session, const char *encoder,
                                                uint32_t frame, const float *embedding,
                                                size_t elements, double *difference);

/* ---- incidents ------------------------------------------------------------------------------ */

/* Counts the incidents of a spec opened with a recorder. An incident is an alarm with the steps
 * before and after it; a complete incident does not change. etlc_reset() completes incidents that
 * wait for steps, and keeps all. `lost`: alarms that began while there was no room for another
 * incident, which the bytes record as well. */
ETLC_EXPORT etlc_status etlc_incidents(etlc_session session, uint32_t *complete, uint32_t *lost);

/* Returns the bytes of a complete incident, for a file that `etlc incident` reads, as the generated
 * class writes them. Valid until the next call of this function or etlc_close(). With ETLC_BOOLEAN
 * all predicates are measured, while the class marks those that no verdict needed. */
ETLC_EXPORT etlc_status etlc_incident(etlc_session session, uint32_t incident, const void **bytes,
                                      size_t *size);

/* Completes the incidents that wait for steps with the present steps. */
ETLC_EXPORT etlc_status etlc_close_incidents(etlc_session session);

/* Drops all incidents, which makes room for new ones. */
ETLC_EXPORT etlc_status etlc_forget_incidents(etlc_session session);

#ifdef __cplusplus
}
#endif

#endif
