/* Frequency response of the membrane with a sheet resistance or a second film: small motion of its rings and of the potentials along
 * the electrode about the equilibrium under a uniform bias, 1 V at the rim,
 *
 *     (K + V K_v + i w K_2 - w^2 M + i w d) u = P v,   i w (C v + P^T u) + Y v = 0 but at the rim,   P = 2 U (1/2) dC/du
 *
 * with V as in radial.h, the dampers K_2 of the second film and d of a load, and the admittance Y of sheets and leakage
 * (network/sheet.h). */
#ifndef DEA_DIRECT_SHEETS_H
#define DEA_DIRECT_SHEETS_H

#include "engine/direct/radial.h"

enum { DEA_SHEETS_MESHES = 6 };

struct dea_sheets_mesh;

typedef struct dea_sheets {
    dea_scene scene;        /* borrows what the scene owns; its rim is at the source */
    const dea_model *model;
    double voltage;         /* bias of the film [V] */
    struct dea_sheets_mesh *meshes[DEA_SHEETS_MESHES]; /* owned: each finer than the one before; NULL: not made yet */
} dea_sheets;

/* The caller ends it with dea_sheets_close(). */
dea_sheets dea_sheets_open(const dea_scene *scene, const dea_model *model, double voltage);
void dea_sheets_close(dea_sheets *sheets);

/* The answer at a frequency per volt at the rim, its charge that of the current but for 1/R_p; false where two meshes do not agree
 * within the accuracy, or memory ran out. */
bool dea_sheets_answer(dea_sheets *sheets, double frequency, double accuracy, dea_per_volt *answer);

#endif
