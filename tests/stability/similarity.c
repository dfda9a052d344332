/* Twins: a scene and its similarity transform. Strains must be the same whatever the size of the actuator. */
#include "stability.h"

#include "../bench/bench.h"

#include <math.h>
#include <stdlib.h>

#define ACTUATOR(kind, coverage)                                                                                                 \
    "actuator: {kind: " kind ", frame_radius: 30 mm, coverage: " coverage ", film_thickness: 100 um, prestretch: 1.2}\n"
#define FILM "yeoh: {C1: 178426 Pa, C2: -6023 Pa, C3: 4234 Pa}, permittivity: 2.8"
#define STATIC(kind, model)                                                                                                      \
    ACTUATOR(kind, "0.5")                                                                                                        \
    "material: {" FILM "}\nmodel: " model "\nstudy: {sweep: {voltage: [0 V, 45 V, 2 kV, 4.5 kV, 8 kV], prestretch: [1.1, "       \
    "1.3]}}\n"
#define BRANCHES ", prony: [{g: 0.1, tau: 3 ms}, {g: 0.05, tau: 0.1 s}]"
#define STEP "waveform: {step: {on: 10 ms, off: 40 ms, voltage: 4.5 kV, rise: 10 us}}"
#define RUN "study: {transient: {until: 80 ms, every: 0.5 ms}}\n"
#define RING ACTUATOR("dot", "0.5") "material: {" FILM ", density: 1080 kg/m^3, retardation: 20 us" BRANCHES "}\n"
#define CREEP ACTUATOR("lens", "0.6") "material: {" FILM BRANCHES "}\n"
#define VISCOUS ACTUATOR("dot", "0.4") "material: {" FILM ", retardation: 2 ms}\n"
#define PORT "series_resistance: 10 MOhm, leakage_resistance: 10 GOhm, "
#define RESPONSE "drive: {series_resistance: 1 MOhm}\nstudy: {ac: {from: 1 Hz, to: 10 kHz, points_per_decade: 10, bias: 3 kV}}\n"

static const stability_subject subjects[] = {
    {"static, pelrine", "direct", STATIC("dot", "pelrine")},
    {"static, constant_force", "direct", STATIC("dot", "constant_force")},
    {"static, lumped", "direct", STATIC("dot", "lumped")},
    {"static, coverage", "direct", STATIC("dot", "coverage")},
    {"static, lame, lens", "direct", STATIC("lens", "lame")},
    {"static, field", "direct", STATIC("dot", "field")},
    {"static, field, lens", "direct", STATIC("lens", "field")},
    {"static, lumped", "ida", STATIC("dot", "lumped")},
    {"static, coverage, lens", "ida", STATIC("lens", "coverage")},
    {"static, field", "ida", STATIC("dot", "field")},
    {"static, constant_force", "ngspice", STATIC("dot", "constant_force")},
    {"static, lumped", "ngspice", STATIC("dot", "lumped")},
    {"static, coverage", "ngspice", STATIC("dot", "coverage")},
    {"static, coverage, lens", "ngspice", STATIC("lens", "coverage")},
    {"static, lame", "ngspice", STATIC("dot", "lame")},
    {"ring, lumped", "direct", RING "drive: {" STEP "}\nmodel: lumped\n" RUN},
    {"ring, lumped", "ida", RING "drive: {" STEP "}\nmodel: lumped\n" RUN},
    {"ring behind 10 MOhm, coverage", "ida", RING "drive: {" PORT STEP "}\nmodel: coverage\n" RUN},
    {"ring, lame", "ida", RING "drive: {" STEP "}\nmodel: lame\n" RUN},
    {"creep, lumped, lens", "direct", CREEP "drive: {" STEP "}\nmodel: lumped\n" RUN},
    {"creep, coverage, lens", "ida", CREEP "drive: {" STEP "}\nmodel: coverage\n" RUN},
    {"creep behind 10 MOhm, coverage, lens", "ida", CREEP "drive: {" PORT STEP "}\nmodel: coverage\n" RUN},
    {"damper, coverage", "ida", VISCOUS "drive: {" STEP "}\nmodel: coverage\n" RUN},
    {"ring, lumped", "ngspice", RING "drive: {" STEP "}\nmodel: lumped\naccuracy: 1e-5\n" RUN},
    {"ring, coverage", "ngspice", RING "drive: {" STEP "}\nmodel: coverage\naccuracy: 1e-4\n" RUN},
    {"ring behind 10 MOhm, coverage", "ngspice", RING "drive: {" PORT STEP "}\nmodel: coverage\naccuracy: 1e-4\n" RUN},
    {"creep, lumped, lens", "ngspice", CREEP "drive: {" STEP "}\nmodel: lumped\naccuracy: 1e-5\n" RUN},
    {"creep, coverage, lens", "ngspice", CREEP "drive: {" STEP "}\nmodel: coverage\naccuracy: 1e-5\n" RUN},
    {"creep behind 10 MOhm, coverage, lens", "ngspice", CREEP "drive: {" PORT STEP "}\nmodel: coverage\naccuracy: 1e-5\n" RUN},
    {"creep behind 10 MOhm, lame, lens", "ngspice", CREEP "drive: {" PORT STEP "}\nmodel: lame\naccuracy: 1e-5\n" RUN},
    {"damper, coverage", "ngspice", VISCOUS "drive: {" STEP "}\nmodel: coverage\naccuracy: 1e-5\n" RUN},
    {"response, lame", "direct", RING "model: lame\n" RESPONSE},
    {"response, coverage", "direct", RING "model: coverage\n" RESPONSE},
    {"response, lame", "ngspice", RING "model: lame\n" RESPONSE},
    {"response, coverage", "ngspice", RING "model: coverage\n" RESPONSE},
};

static const stability_units exact[] = {
    {"all small and soft", 0x1p-14, 0x1p-10, 0x1p-20, 0x1p10, 0x1p-20},
    {"all large and stiff", 0x1p10, 0x1p13, 0x1p20, 0x1p-10, 0x1p20},
    {"in-plane x 2^-14 (1.8 um)", 0x1p-14, 1, 1, 1, 1},
    {"in-plane x 2^10 (31 m)", 0x1p10, 1, 1, 1, 1},
    {"film x 2^-10 (0.1 um)", 1, 0x1p-10, 1, 1, 1},
    {"film x 2^13 (0.8 m)", 1, 0x1p13, 1, 1, 1},
    {"stiffness x 4^-10", 1, 1, 0x1p-20, 1, 1},
    {"stiffness x 4^10", 1, 1, 0x1p20, 1, 1},
    {"time x 2^-20", 1, 1, 1, 1, 0x1p-20},
    {"time x 2^20", 1, 1, 1, 1, 0x1p20},
    {"permittivity x 4^10", 1, 1, 1, 0x1p20, 1},
};

static const stability_units decades[] = {
    {"in-plane x 1e-4", 1e-4, 1, 1, 1, 1}, {"in-plane x 1e3", 1e3, 1, 1, 1, 1},    {"film x 1e-2 (1 um)", 1, 1e-2, 1, 1, 1},
    {"film x 1e4 (1 m)", 1, 1e4, 1, 1, 1}, {"stiffness x 1e-6", 1, 1, 1e-6, 1, 1}, {"stiffness x 1e6", 1, 1, 1e6, 1, 1},
    {"time x 1e-6", 1, 1, 1, 1, 1e-6},     {"time x 1e6", 1, 1, 1, 1, 1e6},
};

size_t stability_subject_count(void)
{
    return sizeof subjects / sizeof subjects[0];
}

const stability_subject *stability_subject_at(size_t index)
{
    return &subjects[index];
}

static size_t units_count(bool of_two)
{
    return of_two ? sizeof exact / sizeof exact[0] : sizeof decades / sizeof decades[0];
}

static double change_by(const stability_subject *subject, const stability_answer *answer, const stability_units *units)
{
    dea_scene twin = stability_scene(subject->text);
    stability_scale(&twin, units);
    stability_answer other = stability_run(&twin, subject->engine);
    const double apart = stability_difference(answer, &other, units);
    free(other.points);
    dea_scene_free(&twin);
    return apart;
}

stability_change stability_similarity(const stability_subject *subject, bool of_two, size_t most)
{
    stability_change change = {0.0, NULL};
    dea_scene scene = stability_scene(subject->text);
    stability_answer answer = stability_run(&scene, subject->engine);
    for (size_t i = 0; i < units_count(of_two) && i < most; i++) {
        const stability_units *units = of_two ? &exact[i] : &decades[i];
        const double apart = change_by(subject, &answer, units);
        if (!(apart <= change.largest)) {
            change = (stability_change){apart, units};
        }
    }
    free(answer.points);
    dea_scene_free(&scene);
    return change;
}
