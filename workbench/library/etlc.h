/* libetlc: the monitors of a spec, stepped by a program that was not compiled with them.
 *
 * Takes: a spec, as text or as a file, with its thresholds and what is fitted. Gives: the verdicts
 * that the generated class gives, bit for bit, and what `etlc explain` says of them. Keeps true:
 * - A call that fails changes nothing, says so by its status, and etlc_message() says why. Nothing
 *   is printed, no exception and no abort leaves the library.
 * - Sessions know nothing of each other. A session is used by one thread at a time; a call of it
 *   during another one is refused with ETLC_BUSY.
 * - After etlc_open(), nothing asks for memory but what says so here.
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

/* Of this header. A library takes programs of its own version and of those before. */
#define ETLC_API_VERSION 2u

/* ---- errors --------------------------------------------------------------------------------- */

typedef int32_t etlc_status;
enum {
  ETLC_OK = 0,
  ETLC_REFUSED = 1,        /* the spec: etlc_message() has its diagnostics */
  ETLC_NULL_POINTER = 2,   /* where something has to be */
  ETLC_NO_SESSION = 3,     /* closed, or never opened */
  ETLC_BUSY = 4,           /* another thread is in a call of the same session */
  ETLC_WRONG_VERSION = 5,  /* a struct_size or api_version that this library does not know */
  ETLC_WRONG_NUMBER = 6,   /* of samples, elements or places for verdicts */
  ETLC_WRONG_TYPE = 7,     /* of a sample's elements */
  ETLC_WRONG_VALUE = 8,    /* of an option, a bool, a distance */
  ETLC_NO_SUCH = 9,        /* index or name */
  ETLC_NOT_KEPT = 10,      /* what etlc_open() was not asked to keep */
  ETLC_UNDECIDED = 11,     /* there is no verdict yet */
  ETLC_ENDED = 12,         /* the episode: etlc_reset() begins another one */
  ETLC_OUT_OF_MEMORY = 13,
  ETLC_INTERNAL = 14 /* a fault of etlc itself */
};

/* Why the last call of this thread failed: one line, or the diagnostics of the spec as etlc prints
 * them. Empty where it did not fail. Good until this thread's next call. Never null. */
ETLC_EXPORT const char *etlc_message(void);

/* The diagnostics of that call as `etlc --diagnostics json` prints them: {"diagnostics": [...]}.
 * After an etlc_open() that did not fail, its warnings. */
ETLC_EXPORT const char *etlc_message_json(void);

/* Of the library, as "0.5.0". */
ETLC_EXPORT const char *etlc_version(void);

/* ---- opening -------------------------------------------------------------------------------- */

/* A spec that is open. 0 is none. A number is never used again, so a closed one stays closed. */
typedef uint64_t etlc_session;

enum { ETLC_ROBUSTNESS = 0, ETLC_BOOLEAN = 1 };           /* what monitors compute with */
enum { ETLC_AS_F32 = 0, ETLC_AS_F16 = 1, ETLC_AS_I8 = 2 }; /* how target sets are stored */

/* As the options of `etlc run`. Begin with `etlc_options options = ETLC_OPTIONS;`. */
typedef struct etlc_options {
  uint32_t struct_size; /* sizeof(etlc_options) */
  uint32_t api_version; /* ETLC_API_VERSION */
  /* Of the spec. With a text it is not read, but paths in the text are relative to it, files beside
   * it are found by it, and messages name it; it may be null then. */
  const char *path;
  const char *text;             /* of the spec; null: it is read from `path` */
  const char *thresholds;       /* a file; null: SPEC.thresholds.json beside the spec */
  const char *fitted;           /* a file; null: SPEC.fitted.npz beside the spec */
  const char *const *settings;  /* of constants, each "NAME=VALUE" */
  size_t setting_count;
  uint32_t values;     /* ETLC_ROBUSTNESS or ETLC_BOOLEAN */
  uint32_t targets_as; /* ETLC_AS_F32, ETLC_AS_F16 or ETLC_AS_I8 */
  uint32_t lets;       /* 1: etlc_let() has what lets say of each step */
  uint32_t reserved;   /* 0 */
  uint64_t max_state;  /* limits of the plan; 0: those of etlc */
  uint64_t max_code;
  uint64_t max_work;
  uint64_t history; /* steps that etlc_explain() can look back at; 0: none are kept */
  /* From version 2 on. BEFORE,AFTER,INCIDENTS: the steps around each alarm that etlc_incident()
   * has, and how many alarms, as "2s,1s,4" or "40,20,4"; null: none are kept. */
  const char *recorder;
} etlc_options;

#define ETLC_OPTIONS \
  {sizeof(etlc_options), ETLC_API_VERSION, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}

/* Compiles the spec, and gives a session before its first step. ETLC_REFUSED where it does not
 * compile. May be called by several threads at once. */
ETLC_EXPORT etlc_status etlc_open(const etlc_options *options, etlc_session *session);

/* Frees all that the session has: every pointer that it gave is gone. */
ETLC_EXPORT etlc_status etlc_close(etlc_session session);

/* ---- what is in it -------------------------------------------------------------------------- */

/* Names and texts are good until etlc_close(). Of every struct the caller sets struct_size. */
typedef struct etlc_description {
  uint32_t struct_size;
  uint32_t inputs;     /* that the spec declares; each wants a sample at every step */
  uint32_t monitors;   /* each gives a verdict at every step */
  uint32_t predicates; /* named ones first */
  uint32_t lets;       /* of those that etlc_let() knows */
  uint32_t horizon;    /* the most that a sliding monitor is late by, in steps */
  double step_seconds; /* 0: the spec says no rate */
  uint64_t state_bytes;
  uint64_t spec_hash; /* XXH64, as in the generated class */
  uint64_t data_hash;
  uint64_t thresholds_hash;
  const char *name;
  const char *warnings; /* of etlc, as it prints them; empty: none */
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
  uint32_t dimension; /* elements; 1 of a scalar or a bool */
  uint32_t hold;      /* missing samples in a row that the last one stands for */
  float low;          /* a scalar's range; -inf, inf: none */
  float high;
  float scale;      /* ETLC_I8: the value of 1 */
  uint32_t is_embedding;
  uint32_t is_used; /* 0: no monitor looks at it, and neither does etlc_step() */
  const char *name;
} etlc_input;

ETLC_EXPORT etlc_status etlc_describe_input(etlc_session session, uint32_t input,
                                            etlc_input *description);

enum { ETLC_NEVER = 0, ETLC_ON_REQUEST = 1, ETLC_WHEN_FINAL = 2 }; /* when a monitor restarts */

typedef struct etlc_monitor {
  uint32_t struct_size;
  uint32_t is_sliding;
  uint32_t restarts; /* ETLC_NEVER, ... */
  uint32_t horizon;  /* of a sliding one: its verdicts are about so many steps ago */
  const char *name;
  const char *formula;
} etlc_monitor;

ETLC_EXPORT etlc_status etlc_describe_monitor(etlc_session session, uint32_t monitor,
                                              etlc_monitor *description);

typedef struct etlc_predicate {
  uint32_t struct_size;
  uint32_t is_measured; /* 0: no monitor needs it */
  uint32_t is_adaptive; /* its threshold moves with etlc_observe() */
  uint32_t has_nearest; /* a plain distance, which has a nearest row */
  const char *name;     /* or, where it has none, what is compared */
  const char *text;     /* "min l2(z, goal) <= 0.25" */
} etlc_predicate;

ETLC_EXPORT etlc_status etlc_describe_predicate(etlc_session session, uint32_t predicate,
                                                etlc_predicate *description);

/* The name of let `let`, counted among those that etlc_let() knows. */
ETLC_EXPORT etlc_status etlc_describe_let(etlc_session session, uint32_t let, const char **name);

enum { ETLC_INPUTS = 0, ETLC_MONITORS = 1, ETLC_PREDICATES = 2, ETLC_LETS = 3 };

/* The index of the input, monitor, predicate or let of that name. */
ETLC_EXPORT etlc_status etlc_find(etlc_session session, uint32_t kind, const char *name,
                                  uint32_t *index);

/* ---- stepping ------------------------------------------------------------------------------- */

/* One input at one step. Its elements are aligned for their type, are read during the call, and are
 * never kept. */
typedef struct etlc_sample {
  const void *data; /* null: missing */
  uint32_t count;   /* elements: the input's dimension */
  uint32_t type;    /* of them: the input's */
} etlc_sample;

enum { /* bits of a verdict's status */
  ETLC_SATISFIED = 1,
  ETLC_VIOLATED = 2,
  ETLC_DECIDED = 4,
  ETLC_FINAL = 8, /* nothing that may come changes it between satisfied and violated */
  ETLC_ALARM = ETLC_VIOLATED | ETLC_DECIDED | ETLC_FINAL /* all three: violated for good */
};

/* What a monitor says after a step. All three numbers are NaN where it is not decided. */
typedef struct etlc_verdict {
  float robustness;
  float lower; /* no continuation takes it below this */
  float upper; /* nor above this */
  uint32_t status;
} etlc_verdict;

/* Violated for good: nothing that may come repairs it. */
static inline int etlc_is_alarm(etlc_verdict verdict) {
  return (verdict.status & ETLC_ALARM) == ETLC_ALARM;
}

/* One step. `samples`: of all inputs, in the order of the spec. A number that is not finite, or out
 * of its input's range, counts as missing. `verdicts`: room for all monitors. */
ETLC_EXPORT etlc_status etlc_step(etlc_session session, const etlc_sample *samples,
                                  size_t sample_count, etlc_verdict *verdicts,
                                  size_t verdict_count);

/* One input at every step: step n has its elements, in a row, `stride` bytes behind those of step
 * n - 1, aligned for their type. */
typedef struct etlc_column {
  const void *data;       /* null: missing throughout */
  const uint8_t *present; /* a byte a step, 0: missing; null: there at all steps */
  int64_t stride;
  uint32_t count;
  uint32_t type;
} etlc_column;

/* `steps` steps, one after the other, as etlc_step() makes them. `verdicts`: room for all monitors
 * at step 0, then at step 1, and so on. */
ETLC_EXPORT etlc_status etlc_run(etlc_session session, const etlc_column *columns,
                                 size_t column_count, uint64_t steps, etlc_verdict *verdicts,
                                 size_t verdict_count);

/* The episode has ended: sliding monitors report one of the positions that are left each time, of
 * which there are `horizon`; the others repeat their last verdict. No step follows. */
ETLC_EXPORT etlc_status etlc_finish(etlc_session session, etlc_verdict *verdicts,
                                    size_t verdict_count);

/* A new episode. Thresholds that have moved stay where they are. */
ETLC_EXPORT etlc_status etlc_reset(etlc_session session);

/* From the next step on, this monitor is about that step. It is one that restarts. */
ETLC_EXPORT etlc_status etlc_restart(etlc_session session, uint32_t monitor);

/* A label for an adaptive threshold: the predicate's distance on a frame, and whether it should
 * have held there. */
ETLC_EXPORT etlc_status etlc_observe(etlc_session session, uint32_t predicate, float distance,
                                     uint32_t truth);

/* ---- after a step --------------------------------------------------------------------------- */

/* Steps since the session was opened or reset. */
ETLC_EXPORT etlc_status etlc_steps(etlc_session session, uint64_t *steps);

/* The step that the last verdict of a monitor is about. */
ETLC_EXPORT etlc_status etlc_position(etlc_session session, uint32_t monitor, uint64_t *position);

typedef struct etlc_measured {
  float distance; /* or the expression; NaN: unknown, or not needed */
  float threshold;
  uint32_t nearest; /* row of the target, of a plain distance */
} etlc_measured;

/* What a predicate came to at the last step. */
ETLC_EXPORT etlc_status etlc_measure(etlc_session session, uint32_t predicate,
                                     etlc_measured *measured);

/* What a let said of the last step. */
ETLC_EXPORT etlc_status etlc_let(etlc_session session, uint32_t let, etlc_verdict *verdict);

typedef struct etlc_counts {
  uint64_t missing;      /* samples that were not there, or not finite */
  uint64_t out_of_range; /* of a scalar */
  uint64_t held;         /* of both, those that the last one stood for */
} etlc_counts;

/* What became of the samples of an input since the session was opened or reset. */
ETLC_EXPORT etlc_status etlc_count(etlc_session session, uint32_t input, etlc_counts *counts);

enum { ETLC_TEXT = 0, ETLC_JSON = 1 };

/* Why the last verdict of a monitor is what it is, as `etlc explain` says it. The text is good
 * until the next call of this or etlc_close(). Needs `history`; asks for memory, and for time as
 * long as the episode. */
ETLC_EXPORT etlc_status etlc_explain(etlc_session session, uint32_t monitor, uint32_t format,
                                     const char **text);

/* ---- incidents ------------------------------------------------------------------------------ */

/* Of a spec that was opened with a recorder. An incident is an alarm that began, the steps before
 * it and those after it; the steps of one that is complete do not change. etlc_reset() completes
 * those that wait for steps, and keeps all. `lost`: alarms that began while there was no room for
 * another, which the bytes say too. */
ETLC_EXPORT etlc_status etlc_incidents(etlc_session session, uint32_t *complete, uint32_t *lost);

/* The bytes of complete incident `incident`, for a file that `etlc incident` reads: those that the
 * generated class writes. Good until the next call of this or etlc_close(). With ETLC_BOOLEAN all
 * predicates are measured, where the class notes which ones no verdict asked for. */
ETLC_EXPORT etlc_status etlc_incident(etlc_session session, uint32_t incident, const void **bytes,
                                      size_t *size);

/* Completes those that wait for steps, with the steps that there are. */
ETLC_EXPORT etlc_status etlc_close_incidents(etlc_session session);

/* Makes room for new ones. */
ETLC_EXPORT etlc_status etlc_forget_incidents(etlc_session session);

#ifdef __cplusplus
}
#endif

#endif
