#include "netlist/rings_small.h"

#include <ctype.h>

#include "film/point.h"
#include "netlist/export.h"

/* Changes of the nominal stresses of a ring over its strains e_a from the bias [Pa]: with the voltage, and those that damper and
 * branches scale, (1/lambda_a) dS_a/de_b. Both are symmetric. */
typedef struct moduli {
    double film[3], viscous[3]; /* 11, 12, 22 */
} moduli;

static moduli moduli_of(const dea_rings_small *s, size_t ring, const dea_membrane_look *look)
{
    const dea_dynamics *film = &s->membrane->film;
    const dea_ring_look *at = &look->rings[ring];
    const double field = s->voltage / film->point.film_thickness, l0 = film->point.film.prestretch;
    const double k = s->membrane->rings.rings[ring].electroded ? film->point.film.permittivity * field * field : 0.0;
    const double *l = at->stretch;
    const dea_electric electric = dea_film_electric(&film->point.film, l[0] * l[1]);
    const double second = k * electric.second, mixed = k * electric.first + second;
    return (moduli){{l0 * (at->tangent[0][0] - second * l[1] * l[1]), l0 * (at->tangent[0][1] - mixed * l[0] * l[1]),
                     l0 * (at->tangent[1][1] - second * l[0] * l[0])},
                    {l0 * at->slope[0][0] / l[0], l0 * at->slope[0][1] / l[0], l0 * at->slope[1][1] / l[1]}};
}

/* A transconductance from node <name><control> into node @p into, number @p number; elements are in capitals. */
static void lever(FILE *out, const char *element, const char *into, size_t number, const char *control, size_t of, double value)
{
    if (value != 0.0) {
        dea_part_print(out, "G%c%zu_%zu 0 %s%zu %s%zu 0 %g\n", toupper(*element), number, of, into, number, control, of, value);
    }
}

static void unit_resistor(FILE *out, const char *node, size_t number)
{
    fprintf(out, "R%c%zu %s%zu 0 1\n", toupper(*node), number, node, number);
}

/* Strains over displacements, or their rates over velocities: nodes a, b of u, c, d of v. */
static void write_strains(FILE *out, const dea_ring *ring, size_t number, const char names[2][2], const char *of)
{
    for (int a = 0; a < 2; a++) {
        for (size_t i = 0; i < ring->count; i++) {
            lever(out, names[a], names[a], number, of, ring->first + i + 1, a == 0 ? ring->radial[i] : ring->hoop[i]);
        }
        unit_resistor(out, names[a], number);
    }
}

/* A symmetric pair of stresses of two strains times a factor. */
static void write_pair(FILE *out, char tag, const char into[2][2], const char from[2][2], size_t number, const double w[3],
                       double factor)
{
    for (int a = 0; a < 2; a++) {
        for (int b = 0; b < 2; b++) {
            dea_part_print(out, "G%c%c%c%zu 0 %s%zu %s%zu 0 %g\n",
                           tag, toupper(*into[a]), toupper(*from[b]), number, into[a], number, from[b], number, factor * w[a + b]);
        }
    }
}

static const char strain_names[2][2] = {"a", "b"}, rate_names[2][2] = {"c", "d"}, stress_names[2][2] = {"s", "t"},
                  viscous_names[2][2] = {"x", "y"};

/* Branches follow the stress y that scales them: tau z' = y - z, c (y - z) acts. */
static void write_branches(FILE *out, const dea_dynamics *film, size_t number)
{
    for (int a = 0; a < 2; a++) {
        const char *stress = stress_names[a], *viscous = viscous_names[a];
        for (size_t i = 0; i < film->branch_count; i++) {
            const int name = toupper(*viscous);
            fprintf(out, "GZ%c%zu_%zu 0 z%s%zu_%zu %s%zu z%s%zu_%zu 1\n", name, number, i + 1, viscous, number, i + 1, viscous,
                    number, viscous, number, i + 1);
            fprintf(out, "CZ%c%zu_%zu z%s%zu_%zu 0 {tau%zu}\n", name, number, i + 1, viscous, number, i + 1, i + 1);
            fprintf(out, "GR%c%zu_%zu 0 %s%zu %s%zu z%s%zu_%zu {share%zu}\n", name, number, i + 1, stress, number, viscous,
                    number, viscous, number, i + 1, i + 1);
        }
    }
}

static void write_ring(FILE *out, const dea_rings_small *s, size_t index, const dea_membrane_look *look)
{
    const dea_dynamics *film = &s->membrane->film;
    const dea_ring *ring = &s->membrane->rings.rings[index];
    const moduli w = moduli_of(s, index, look);
    const size_t number = index + 1;
    const double lever_size = ring->volume * film->point.film.prestretch;
    fprintf(out, "* ring %zu at R = %.6g m: strains a, b, stresses s, t [Pa]\n", number, ring->radius);
    write_strains(out, ring, number, strain_names, "u");
    write_pair(out, 'W', stress_names, strain_names, number, w.film, 1.0);
    if (film->retardation > 0.0) {
        write_strains(out, ring, number, rate_names, "v");
        write_pair(out, 'K', stress_names, rate_names, number, w.viscous, film->retardation);
    }
    if (film->branch_count > 0) {
        write_pair(out, 'Y', viscous_names, strain_names, number, w.viscous, 1.0);
        unit_resistor(out, "x", number);
        unit_resistor(out, "y", number);
        write_branches(out, film, number);
    }
    for (int a = 0; a < 2; a++) {
        unit_resistor(out, stress_names[a], number);
        for (size_t i = 0; i < ring->count; i++) {
            const double slope = a == 0 ? ring->radial[i] : ring->hoop[i];
            const size_t node = ring->first + i + 1;
            if (slope != 0.0) {
                dea_part_print(out, "GF%c%zu_%zu v%zu 0 %s%zu 0 %g\n",
                               toupper(*stress_names[a]), number, node, node, stress_names[a], number, lever_size * slope);
            }
        }
    }
}

static void write_node(FILE *out, const dea_rings_small *s, size_t index, double transduction)
{
    const size_t n = index + 1;
    fprintf(out, "* node %zu at R = %.6g m: mass [kg], displacement, transduction 2 phi U [N/V]\n", n,
            s->membrane->rings.radii[index]);
    if (s->membrane->masses[index] > 0.0) {
        dea_part_print(out, "CM%zu v%zu 0 %g\n", n, n, s->membrane->masses[index]);
    }
    dea_part_print(out,
                   "GU%zu 0 u%zu v%zu 0 1\n"
                   "CU%zu u%zu 0 1\n"
                   "GP%zu 0 v%zu film 0 %g\n"
                   "GI%zu film 0 v%zu 0 %g\n"
                   "GQ%zu 0 motion u%zu 0 %g\n",
                   n, n, n, n, n, n, n, transduction, n, n, transduction, n, n, transduction);
}

static void write_port(FILE *out, const dea_dynamics *film, double capacitance)
{
    fputs("* source of 1 V, resistances [Ohm], capacitance of the film at the bias [F]\n", out);
    fputs(film->series > 0.0 ? "VSOURCE source 0 dc 0 ac 1\n" : "VSOURCE film 0 dc 0 ac 1\n", out);
    if (film->series > 0.0) {
        dea_part_value(out, "r_series", film->series);
        fputs("RSERIES source film {r_series}\n", out);
    }
    if (film->conductance > 0.0) {
        dea_part_value(out, "r_leak", 1.0 / film->conductance);
        fputs("RLEAK film 0 {r_leak}\n", out);
    }
    dea_part_value(out, "c_film", capacitance);
    fputs("CFILM film 0 {c_film}\nRMOTION motion 0 1\n", out);
}

void dea_rings_small_write(const dea_rings_small *small, FILE *out)
{
    const dea_membrane *m = small->membrane;
    double push[DEA_RINGS_NODES];
    dea_membrane_look look;
    if (!dea_membrane_look_at(m, small->u, &look)) {
        return; /* an equilibrium has one */
    }
    dea_membrane_push(m, &look, push);
    fprintf(out, "* membrane as %zu moving nodes (degrees of disc and annulus: %zu, %zu) about its bias; the edge at r_a is node %zu\n",
            m->rings.node_count, m->rings.mesh.disc, m->rings.mesh.annulus, m->rings.edge + 1);
    for (size_t i = 0; i < m->film.branch_count; i++) {
        dea_part_print(out, ".param tau%zu=%g\n.param share%zu=%g\n",
                       i + 1, m->film.branches[i].tau, i + 1, m->film.branches[i].share);
    }
    write_port(out, &m->film, look.capacitance);
    for (size_t n = 0; n < m->rings.node_count; n++) {
        write_node(out, small, n, 2.0 * push[n] * small->voltage);
    }
    if (m->film.damping > 0.0) {
        dea_part_print(out, "* mechanical resistance of the load [N s/m]\nRLOAD v%zu 0 %g\n",
                       m->rings.edge + 1, 1.0 / m->film.damping);
    }
    const double stiffness = dea_point_spring(&m->film.point, look.edge).slope;
    if (stiffness > 0.0) {
        dea_part_print(out, "* spring of the load between edge and frame [N/m]\nGLOAD v%zu 0 u%zu 0 %g\n",
                       m->rings.edge + 1, m->rings.edge + 1, stiffness);
    }
    for (size_t q = 0; q < m->rings.ring_count; q++) {
        write_ring(out, small, q, &look);
    }
}
