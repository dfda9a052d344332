/* Figures of numerical stability: convergence orders, conditioning, freedom of units, compilers. */
#ifndef DEA_STABILITY_H
#define DEA_STABILITY_H

#include "deaspice/engine.h"

/* Ends the program with a message. */
_Noreturn void stability_give_up(const char *format, ...) DEA_PRINTF(1, 2);

/* Factors of a similarity transform: it leaves every strain as it is. */
typedef struct stability_units {
    const char *name;
    double length;       /* of all in the plane of the film */
    double thickness;    /* of the film */
    double stress;       /* of its elastic constants */
    double permittivity; /* of the film */
    double time;
} stability_units;

/* A scene from YAML; the caller ends it with dea_scene_free(). */
dea_scene stability_scene(const char *text);
/* Transforms a scene. */
void stability_scale(dea_scene *scene, const stability_units *units);

/* All that a study gave. */
typedef struct stability_answer {
    const dea_scene *scene; /* borrowed */
    char *points;           /* owned: free() */
    char log[300];          /* what the engine said last about points that failed */
} stability_answer;

/* Runs a study of one model; the caller frees answer.points. */
stability_answer stability_run(const dea_scene *scene, const char *engine);
/* The summary of a transient of one point. */
dea_summary stability_summary(const stability_answer *answer);
/* Largest difference of two answers, each column over its peak, @p b being that of the scene of @p a transformed; infinite where
 * states differ. */
double stability_difference(const stability_answer *a, const stability_answer *b, const stability_units *units);

/* Scenes of the similarity figures. */
typedef struct stability_subject {
    const char *name, *engine, *text;
} stability_subject;

size_t stability_subject_count(void);
const stability_subject *stability_subject_at(size_t index);
/* Transforms; exact ones have powers of two as factors, so that rounding itself is similar. */
size_t stability_units_count(bool exact);
const stability_units *stability_units_at(bool exact, size_t index);
/* Largest difference that a transform makes to the subject's answer, and the share of estimated errors, scaled over not. */
double stability_similarity(const stability_subject *subject, const stability_units *units);

/* What a method is given: the width of its steps, a tolerance of one step, the accuracy of the scene; or the steps that it took,
 * whose width is 1 over their number. */
typedef enum stability_knob { STABILITY_STEP, STABILITY_STEPS, STABILITY_TOLERANCE, STABILITY_ACCURACY } stability_knob;

struct stability_order;

/* A method whose error falls with a power of its knob. */
typedef struct stability_case {
    const char *name, *engine;
    stability_knob knob;
    const char *theory; /* the power */
    double least, most; /* slopes that pass */
    struct stability_order (*measure)(const struct stability_case *which);
    const char *scene;
} stability_case;

/* What was measured. */
typedef struct stability_order {
    const stability_case *which;
    double slope;          /* of log error over log knob */
    double largest, least; /* errors of the first and the last run, relative */
} stability_order;

size_t stability_case_count(void);
stability_order stability_order_of(size_t index);

#endif
