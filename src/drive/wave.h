/* What the kinds of waveform are: one row of src/drive/waves.c and one file each. The reader, --set, axes, the netCDF file and the
 * units of ngspice work from the numbers that a kind lists, the engines from the segments that it lays out. */
#ifndef DEA_DRIVE_WAVE_H
#define DEA_DRIVE_WAVE_H

#include "deaspice/scene.h"

/* One number of a waveform: the key below drive.waveform.<name>. */
typedef struct dea_wave_number {
    const char *name;
    size_t offset;        /* of the double in dea_waveform; in a list, of the first entry */
    const char *unit;     /* "V", "s", "Hz", "rad" or "1" */
    double low, high;     /* range */
    bool open;            /* the range is without its ends */
    bool needed;          /* the scene must give it */
    double preset;        /* where the scene does not */
    const char *accepted; /* for messages */
} dea_wave_number;

/* Waveforms between which those of all runs of a scene lie, each number at its lowest and at its highest. */
typedef struct dea_wave_bounds {
    const dea_waveform *low, *high;
    double every;    /* longest interval of the samples [s] */
    double shortest; /* between two edges [s]; 0 while numbers are in units of a run */
} dea_wave_bounds;

/* What is wrong with a waveform. */
typedef struct dea_wave_fault {
    const dea_wave_number *number; /* at fault */
    const char *problem;
    bool period; /* it is the period that asks for the number, which is missing */
    char accepted[128];
} dea_wave_fault;

struct dea_wave_builder;

typedef struct dea_wave {
    const char *path;     /* e.g. "drive.waveform.step" */
    const char *alias;    /* another key for it, NULL: none */
    const char *accepted; /* of the mapping, for messages */
    bool settles;         /* it is one step, whose edges have rise and settling times */
    bool pure;            /* it is one sine, which has harmonics */
    const dea_wave_number *numbers;
    size_t number_count;       /* 0: the table of points */
    size_t stride;             /* of a list, from one entry to the next in dea_waveform; 0: a mapping */
    const char *word;          /* name of the key that has a choice of words, NULL: none */
    const char *const *words;  /* which, ends with NULL */
    const char *choices;       /* the same for messages */
    const char *once;          /* why it takes no period, NULL: it does */
    const char *until;         /* what a period accepts */
    /* False with the fault where numbers do not fit together; NULL: they always do. */
    bool (*fits)(const dea_wave_bounds *bounds, dea_wave_fault *fault);
    /* Of what repeats: time of its last corner, latest of all runs; of its first one, soonest; how long an edge takes [s]. */
    void (*extent)(const dea_wave_bounds *bounds, double *first, double *last, double *rise);
    /* Lays out one period, or all of what does not repeat, from time @p begin to @p end. */
    void (*lay)(struct dea_wave_builder *builder, const dea_waveform *wave, double begin, double end);
} dea_wave;

/* Row of a kind; NULL for none, and past the last kind. */
const dea_wave *dea_wave_of(dea_wave_kind kind);
/* Properties of a waveform's kind; false for none. */
static inline bool dea_wave_settles(const dea_waveform *wave)
{
    return dea_wave_of(wave->kind) && dea_wave_of(wave->kind)->settles;
}
static inline bool dea_wave_is_pure(const dea_waveform *wave)
{
    return dea_wave_of(wave->kind) && dea_wave_of(wave->kind)->pure;
}
/* True of a table of points. */
static inline bool dea_wave_is_listed(const dea_waveform *wave)
{
    return dea_wave_of(wave->kind) && dea_wave_of(wave->kind)->number_count == 0;
}
/* Its name: the end of its path. */
const char *dea_wave_name(const dea_wave *wave);
/* Place of number @p index of entry @p entry. */
double *dea_wave_at(const dea_wave *wave, dea_waveform *waveform, size_t index, size_t entry);
/* A waveform of no kind, its numbers NAN. */
dea_waveform dea_waveform_none(void);
/* Fills a fault; for fits(). */
bool dea_wave_blame(dea_wave_fault *fault, const dea_wave_number *number, const char *problem, const char *accepted);
/* Time between two moments that are sums of others: 0 where it is their rounding. */
double dea_wave_gap(double to, double from);
/* True where edges that take that time and lie so far apart touch in a corner, or keep the shortest distance. */
bool dea_wave_apart(double gap, double rise, double shortest);

/* amplitude sin(2 pi n + phase), whose turns n at age t are f t + rate t^2/2, or f (e^(growth t) - 1)/growth of a chirp whose
 * frequency grows by equal factors. */
typedef struct dea_tone {
    double amplitude; /* [V] */
    double frequency; /* at age 0 [Hz] */
    double phase;     /* [rad] */
    double rate;      /* [Hz/s] */
    double growth;    /* [1/s] */
} dea_tone;

/* For lay(): false where a waveform repeats more often than a run has room for, which then fails. */
bool dea_lay_affords(struct dea_wave_builder *builder, double repeats);
/* A straight line, a part of the sum of sines, which the builder cuts at the end of the run. */
void dea_lay_line(struct dea_wave_builder *builder, double from, double to, double start, double end);
void dea_lay_curve(struct dea_wave_builder *builder, double from, double to);
/* Sets what curves are; @p origin: time from which their phases count [s]. */
void dea_lay_tones(struct dea_wave_builder *builder, double offset, const dea_tone *tones, size_t count);
void dea_lay_origin(struct dea_wave_builder *builder, double origin);

#endif
