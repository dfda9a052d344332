/* Figures of numerical stability: convergence orders, conditioning, freedom of units, compilers. */
#ifndef DEA_STABILITY_H
#define DEA_STABILITY_H

#include "deaspice/engine.h"

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
/* Largest difference that a transform makes to the subject's answer: out of the first @p most of those with powers of two as
 * factors, by which rounding itself is similar, or of others. */
typedef struct stability_change {
    double largest;
    const stability_units *worst; /* NULL: none makes any */
} stability_change;

stability_change stability_similarity(const stability_subject *subject, bool powers_of_two, size_t most);

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

/* Largest error of the strain of a closed form, against the same equations in extended precision. */
double stability_rounding(const char *model, dea_kind kind);

size_t stability_case_count(void);
stability_order stability_order_of(size_t index);

/* Condition numbers (2-norm) of the matrices of a time step, before and after scaling; infinite where rounding cannot tell them
 * from singular ones. */
typedef struct stability_condition {
    const char *name;
    double network, network_scaled; /* of the network in the mobility analogy: in SI, in the units of the run */
    double network_best;            /* with all rows and columns scaled: no choice of units gives less by much */
    double ida, ida_scaled;         /* of IDA's Jacobian: in SI, in unknowns of size 1 */
} stability_condition;

size_t stability_condition_count(void);
stability_condition stability_condition_of(size_t index);

/* What the numbers of one program differ by from those of the first. */
typedef struct stability_difference_found {
    double largest; /* of any column over its peak; infinite where rows or states differ */
    char where[64]; /* the example */
    size_t examples;
} stability_difference_found;

/* Runs all scenes of a folder by every program that the engine can do; @p found: one for each program. */
void stability_compare_programs(const char *const *programs, size_t count, const char *folder, const char *engine,
                                stability_difference_found *found);

#endif
