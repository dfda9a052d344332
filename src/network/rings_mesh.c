#include "network/rings_mesh.h"

#include <math.h>

/* Coverage below which the annulus, much longer than its inner radius, has its nodes even in ln R. */
static const double small_disc = 0.1;

static const double doubt = 1.5;         /* most that the error of the better of two runs is taken for, over their difference */
static const double certainty = 0.75;    /* the same where the film is smooth */
static const double smooth_enough = 1.0; /* of smoothness over the spacing of the nodes */

/* Behind an edge the error of the mesh falls by 10^(-gain s^(1/4)) a node, s its smoothness: measured for s = 0.1 to 1.3. So many nodes leave
 * such a share of the accuracy; never less than that share of the usual number, for s tells nothing of films at rest. */
static const double gain = 0.92, left = 0.05, fewest = 0.55;

static const double resolved = 0.25; /* of the root of a front's width, over the spacing of nodes that follow it */

/* Time that a wave takes from centre to frame [s]: J1(3.83) = 0 there. */
static double crossing_of(const dea_membrane_rest *rest)
{
    return 3.83 / rest->slowest;
}

/* Time over which all waves are smooth, over that of a crossing [1]. A damper spreads them by sqrt(tau t): where no sample looks for a
 * while, by as much as one so many times as strong does by the first crossing. */
static double smoothness(const dea_membrane *m, const dea_membrane_rest *rest)
{
    const double crossing = crossing_of(rest), age = fmax(1.0, m->unseen / crossing);
    const double charging = m->film.series * rest->capacitance;
    const double waves = m->heavy ? fmax(2.0 * DEA_PI * dea_membrane_least_damper(m) * age, charging) / crossing : INFINITY;
    return fmin(resolved * sqrt(m->sheet.front), waves); /* nodes lie closer to the rim by their number squared */
}

/* Share of the nodes that an element takes that is so long, of two. */
static size_t degree_of(double nodes, double length, double least)
{
    return (size_t)fmin(DEA_RINGS_DEGREE, fmax(least, ceil(nodes * (0.4 + 1.2 * length))));
}

/* Without waves the disc is uniform, and the annulus wants its nodes even in ln R (physics: section 7, the table of statics). */
static dea_rings_mesh quiet_mesh(double nodes, double coverage)
{
    const double decades = log(1.0 / coverage);
    const double degree = ceil(nodes * (0.5 + 0.1 * decades) - 1.0 + 0.4 * decades);
    return (dea_rings_mesh){1, (size_t)fmin(DEA_RINGS_DEGREE, fmax(3.0, degree)), true};
}

/* Nothing travels through a film without mass, but for charge through the resistance of its electrodes. */
static bool is_quiet(const dea_scene *scene, dea_point *point)
{
    dea_film_prepare(scene, &point->film);
    dea_point_place(scene, point);
    const bool heavy = !scene->reduction.mass && dea_point_mass(scene, point) > 0.0;
    return !heavy && !(scene->electrode.sheet_resistance > 0.0);
}

dea_rings_mesh dea_rings_mesh_of(const dea_scene *scene, double nodes)
{
    dea_point point;
    const bool quiet = is_quiet(scene, &point);
    const double b = point.coverage;
    const dea_rings_mesh mesh = {degree_of(nodes, b, 3.0), degree_of(nodes, 1.0 - b, 3.0), b < small_disc};
    return quiet ? quiet_mesh(nodes, b) : mesh;
}

dea_rings_mesh dea_rings_usual_mesh(const dea_scene *scene)
{
    const dea_actuator *actuator = &scene->actuator;
    const double coverage = isnan(actuator->divide_radius) ? actuator->coverage : actuator->divide_radius / actuator->frame_radius;
    return (dea_rings_mesh){8, 16, coverage < small_disc};
}

bool dea_rings_stays_rough(const dea_scene *scene, const dea_model *model)
{
    dea_membrane m;
    dea_membrane_rest rest;
    return dea_membrane_open(scene, model, dea_rings_usual_mesh(scene), &m, NULL) == DEA_OK && dea_membrane_at_rest(&m, &rest) &&
           !(smoothness(&m, &rest) * DEA_RINGS_DEGREE > smooth_enough);
}

double dea_rings_first_nodes(double accuracy)
{
    return 2.5 - 1.45 * log10(accuracy);
}

double dea_rings_foreseen_nodes(const dea_membrane *m, const dea_membrane_rest *rest, double accuracy)
{
    const double usual = dea_rings_first_nodes(accuracy), s = smoothness(m, rest);
    const double foreseen = -log10(left * accuracy) / (gain * pow(s, 0.25));
    return m->heavy && m->sheet.places == 0 ? fmin(usual, fmax(fewest * usual, foreseen)) : usual;
}

double dea_rings_more_nodes(const dea_membrane *m, const dea_membrane_rest *rest, double nodes)
{
    return smoothness(m, rest) * nodes > smooth_enough ? nodes + 2.0 : 1.5 * nodes;
}

double dea_rings_mesh_trust(const dea_membrane *m, const dea_membrane_rest *rest, double nodes)
{
    return smoothness(m, rest) * nodes > smooth_enough ? certainty : doubt;
}

/* Elements that two meshes cut alike tell nothing of their own error, but for a disc that is uniform. */
static bool tells(dea_rings_mesh coarse, dea_rings_mesh fine)
{
    return fine.annulus != coarse.annulus && (fine.disc != coarse.disc || fine.disc == 1);
}

bool dea_rings_finer_mesh(const dea_scene *scene, const dea_membrane *m, const dea_membrane_rest *rest, double *nodes, dea_rings_mesh *mesh)
{
    const dea_rings_mesh before = *mesh;
    do { /* a short element takes so small a share of the nodes that two more may not change it */
        *nodes = dea_rings_more_nodes(m, rest, *nodes);
        *mesh = dea_rings_mesh_of(scene, *nodes);
    } while (!tells(before, *mesh) && mesh->annulus < DEA_RINGS_DEGREE && mesh->disc < DEA_RINGS_DEGREE);
    return tells(before, *mesh);
}
