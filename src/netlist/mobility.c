/* Force balance at the node `edge` (current): mass, springs, dampers and branches against the electrostatic force. Displacement
 * is an output of the network: the flux of the spring, n times its current, or where the spring is hyperelastic the integral of
 * the edge velocity in a capacitor of 1. `uic` with ic= everywhere: springs as inductors have no operating point. In the other
 * analogy the same elements are the links m0, m1, ... 0 of a loop. */
#include "netlist/mobility.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "expression/derivative.h"
#include "expression/formula.h"
#include "film/point.h"
#include "support/named.h"

static const dea_analogy analogies[] = {
    {"mobility", "mobility analogy: v(edge) = velocity [m/s], current = force [N], compliance = inductor, mass = capacitor", 'C',
     'L', false},
    {"impedance", "impedance analogy: voltage = force [N], current = velocity [m/s], compliance = capacitor, mass = inductor",
     'L', 'C', true},
};

const dea_cures dea_part_cures = {
    .per_metre = 1e6, .drift = 1e-9, .inertia = 1e-6, .lightest = 1e-24, .stop = 1e-3, .fastest = 1e9, .sense = 1e-3};

DEA_NAMED_ROWS(dea_analogy, analogies, &analogies[index])

dea_status dea_mobility_take(dea_mobility *mobility, dea_error *error)
{
    const dea_dynamics *dynamics = mobility->dynamics;
    dea_network *network = &mobility->network;
    dea_pool *pool = &network->pool;
    dea_dynamics_stresses(dynamics, network, mobility->stresses);
    mobility->tension = dea_network_tension(network);
    mobility->tense = dea_expr_constant(pool, mobility->tension) != 0.0;
    mobility->push = dea_dynamics_push(dynamics, network);
    dea_expr viscous = NUM(0.0);
    for (size_t a = 0; a < dynamics->stress_count; a++) {
        viscous = ADD(viscous, MUL(mobility->stresses[a].lever, dea_expr_slope(pool, mobility->stresses[a].stress)));
    }
    mobility->resistance = viscous;
    return pool->exhausted ? dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a network is built") : DEA_OK;
}

/* Takes the expressions so that every product has one parameter. */
static dea_status take_gathered(dea_mobility *mobility, dea_error *error)
{
    dea_pool *pool = &mobility->network.pool;
    dea_network_gather(&mobility->network);
    const dea_status status = dea_mobility_take(mobility, error);
    dea_expr *const single[] = {&mobility->tension, &mobility->push, &mobility->resistance};
    for (size_t i = 0; i < sizeof single / sizeof *single; i++) {
        *single[i] = dea_expr_gathered(pool, *single[i]);
    }
    for (size_t a = 0; a < mobility->dynamics->stress_count; a++) {
        mobility->stresses[a].stress = dea_expr_gathered(pool, mobility->stresses[a].stress);
        mobility->stresses[a].lever = dea_expr_gathered(pool, mobility->stresses[a].lever);
    }
    return status == DEA_OK && pool->exhausted ? dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a network is built") : status;
}

dea_status dea_mobility_open(const dea_scene *scene, const dea_dynamics *dynamics, dea_mobility *mobility, dea_error *error)
{
    dea_scene film = *scene;
    film.drive.voltage = 1.0;
    film.drive.series_resistance = film.drive.leakage_resistance = (double)NAN;
    *mobility = (dea_mobility){.dynamics = dynamics, .stiffness = (double)NAN};
    dea_status status =
        dea_network_build_named(&film, dynamics->model, NULL, &mobility->quantities, &mobility->network, error);
    status = status ? status : take_gathered(mobility, error);
    if (status == DEA_OK) {
        mobility->rest = dea_point_capacitance(&dynamics->point);
        mobility->stiffness = dynamics->linear ? dea_dynamics_linear(dynamics).stiffness : (double)NAN;
    }
    return status;
}

void dea_mobility_close(dea_mobility *mobility)
{
    if (mobility) {
        dea_network_free(&mobility->network);
    }
}

void dea_mobility_displace(dea_mobility *mobility)
{
    mobility->displaced = true;
    mobility->stiffness = (double)NAN;
}

dea_status dea_mobility_prepare(const dea_scene *scene, const dea_model *model, const dea_analogy *analogy, dea_dynamics *dynamics,
                                dea_mobility *mobility, dea_error *error)
{
    *mobility = (dea_mobility){.dynamics = dynamics};
    dea_status status = dea_dynamics_open(scene, model, dynamics, error);
    if (status == DEA_OK) {
        dea_dynamics_lighten(dynamics, scene->accuracy);
        status = dea_mobility_open(scene, dynamics, mobility, error);
    }
    if (status == DEA_OK && dea_dynamics_is_free(dynamics) && !analogy->loop) {
        dea_mobility_displace(mobility);
    }
    return status;
}

static dea_stress_node mobility_stress_node(const dea_dynamics *dynamics, size_t index)
{
    dea_stress_node node = {"stress"};
    if (dynamics->stress_count > 1) {
        snprintf(node.name, sizeof node.name, "stress%zu", index + 1);
    }
    return node;
}

static bool is_linear(const dea_cards *c)
{
    return !c->mobility || !isnan(c->mobility->stiffness);
}

/* ---- pieces of a card */

static void indexed(const dea_cards *c, const char *name, size_t index, double value)
{
    char whole[32];
    snprintf(whole, sizeof whole, "%s%zu", name, index);
    dea_part_value(c->out, whole, value);
}

/* A mechanical resistance [N s/m] as the value of its resistor: in the mobility analogy its inverse. */
static double resistance(const dea_cards *c, double value)
{
    return c->form.analogy->loop ? value : 1.0 / value;
}

/* Takes the place of the next element of the mechanics. */
static void place(dea_cards *c)
{
    if (c->form.analogy->loop) {
        snprintf(c->ends[0], sizeof c->ends[0], "m%d", c->links);
        snprintf(c->ends[1], sizeof c->ends[1], "m%d", ++c->links);
    } else {
        snprintf(c->ends[0], sizeof c->ends[0], "%s", c->mobility && c->mobility->displaced ? "disp" : "edge");
        snprintf(c->ends[1], sizeof c->ends[1], "0");
    }
}

/* A compliance or a mass; a transient gives its state at the start. */
static void write_store(const dea_cards *c, char letter, const char *name, const char *from, const char *to, const char *value,
                        const char *start)
{
    fprintf(c->out, "%c%s %s %s {%s}", letter, name, from, to, value);
    if (c->mobility) {
        fprintf(c->out, " ic={%s}", start);
    }
    fprintf(c->out, "%s\n", letter == 'L' ? c->form.dialect->inductor : "");
}

/* Begins a behavioural source of a force: onto the edge, or against its motion. */
static void begin_force(dea_cards *c, const char *name, bool onto)
{
    const bool loop = c->form.analogy->loop;
    const dea_quantity quantity = loop ? DEA_VOLTAGE : DEA_CURRENT;
    if (loop && onto) {
        dea_dialect_source_begin(c->form.dialect, c->out, quantity, name, "m0", "0");
        return;
    }
    place(c);
    dea_dialect_source_begin(c->form.dialect, c->out, quantity, name, onto ? "0" : c->ends[0], onto ? c->ends[0] : c->ends[1]);
}

static void end_force(const dea_cards *c)
{
    dea_dialect_source_end(c->form.dialect, c->out);
}

/* ---- linear mechanics */

/* All springs as one, whose flux (mobility) or charge (impedance) is the displacement, n times its force. Small signals have a
 * source that senses its force, for v(disp); a transient is spared its two unknowns. */
static void write_spring(dea_cards *c)
{
    place(c);
    fputs("* compliance of all parallel springs [m/N], n times its force is the displacement [m]\n", c->out);
    if (c->form.analogy->loop) {
        write_store(c, c->form.analogy->spring, "SPRING", c->ends[0], c->ends[1], "n_spring", "f_start");
        fprintf(c->out, "EDISP disp 0 %s %s {n_spring}\n", c->ends[0], c->ends[1]);
    } else if (c->mobility) {
        write_store(c, c->form.analogy->spring, "SPRING", c->ends[0], c->ends[1], "n_spring", "f_start");
    } else {
        fputs("VSPRING edge spring 0\n", c->out);
        write_store(c, c->form.analogy->spring, "SPRING", "spring", "0", "n_spring", NULL);
        fputs("HDISP disp 0 VSPRING {n_spring}\n", c->out);
    }
}

/* A branch of the Prony series: spring and damper feel the same force, so they lie in series, in the loop beside each other. */
static void write_branch(dea_cards *c, size_t number)
{
    char name[24], value[24], start[24], middle[24];
    const bool loop = c->form.analogy->loop;
    snprintf(name, sizeof name, "BRANCH%zu", number);
    snprintf(value, sizeof value, "n_branch%zu", number);
    snprintf(start, sizeof start, "f_branch%zu", number);
    snprintf(middle, sizeof middle, "b%zu", number);
    fprintf(c->out,
            "* branch %zu of the prony series: compliance n/c [m/N], c its share of the long-term stiffness, and mechanical "
            "resistance tau c/n [N s/m]%s\n",
            number, loop ? "" : ", whose inverse is the resistor");
    place(c);
    write_store(c, c->form.analogy->spring, name, c->ends[0], loop ? c->ends[1] : middle, value, start);
    fprintf(c->out, "RBRANCH%zu %s %s {r_branch%zu}\n", number, loop ? c->ends[0] : middle, c->ends[1], number);
}

static void write_linear_springs(dea_cards *c)
{
    write_spring(c);
    for (size_t i = 1; i <= c->dynamics->branch_count; i++) {
        write_branch(c, i);
    }
    if (c->dynamics->retardation > 0.0) {
        place(c);
        fprintf(c->out, "* kelvin-voigt damper, tau/n [N s/m]%s\nRDAMPER %s %s {r_damper}\n",
                c->form.analogy->loop ? "" : ", whose inverse is the resistor", c->ends[0], c->ends[1]);
    }
}

/* Stiffness of the springs, and of those that branches and damper follow [N/m]. */
static void write_linear_numbers(const dea_cards *c, double stiffness, double viscous, const dea_mobility_state *start)
{
    const dea_dynamics *d = c->dynamics;
    dea_part_value(c->out, "n_spring", 1.0 / stiffness);
    if (start) {
        dea_part_value(c->out, "f_start", stiffness * start->u);
    }
    for (size_t i = 0; i < d->branch_count; i++) {
        const dea_branch *branch = &d->branches[i];
        const double k = viscous * branch->share;
        indexed(c, "n_branch", i + 1, 1.0 / k);
        indexed(c, "r_branch", i + 1, resistance(c, k * branch->tau));
        if (start) {
            indexed(c, "f_branch", i + 1, branch->share * (stiffness * start->u - start->z[i]));
        }
    }
    if (d->retardation > 0.0) {
        dea_part_value(c->out, "r_damper", resistance(c, d->retardation * viscous));
    }
}

void dea_cards_write_inertia(const dea_cures *cures, const char *tag, const char *node, const char *mass, FILE *out)
{
    fprintf(out, "EMASS%s ma%s 0 %s 0 %.15g\nCMASS%s ma%s mb%s {%s}\nVMASS%s mb%s 0 0\nFMASS%s %s 0 VMASS%s {f_mass}\n", tag, tag, node,
            cures->inertia, tag, tag, tag, mass, tag, tag, tag, node, tag);
}

static void write_mass(dea_cards *c)
{
    const dea_cures *cures = c->form.cures;
    if (!(c->dynamics->mass > 0.0)) {
        return;
    }
    fputs("* mass that moves with the edge [kg]\n", c->out);
    if (cures) {
        dea_cards_write_inertia(cures, "", "edge", "inertia", c->out);
        return;
    }
    place(c);
    write_store(c, c->form.analogy->mass, "MASS", c->ends[0], c->ends[1], "m_edge", "v_start");
}

static void write_load(dea_cards *c)
{
    if (c->dynamics->damping > 0.0) {
        place(c);
        fprintf(c->out, "* mechanical resistance of the load [N s/m]%s\nRLOAD %s %s {r_load}\n",
                c->form.analogy->loop ? "" : ", whose inverse is the resistor", c->ends[0], c->ends[1]);
    }
}

static void write_mass_numbers(const dea_cards *c, double mass)
{
    if (mass > 0.0) {
        dea_part_value(c->out, "m_edge", mass);
    }
    if (c->dynamics->damping > 0.0) {
        dea_part_value(c->out, "r_load", resistance(c, c->dynamics->damping));
    }
}

/* Closes the loop over a source of 0 V, whose current is the velocity; v(edge) is then the velocity as in the other analogy. */
static void close_loop(const dea_cards *c)
{
    if (c->form.analogy->loop) {
        fprintf(c->out, "* velocity of the edge [m/s], the current of the loop\nVLOOP m%d 0 0\nHEDGE edge 0 VLOOP 1\n", c->links);
    }
}

/* ---- hyperelastic mechanics */

/* What the branches relax to: a stress, or the displacement where the springs are linear. */
static dea_stress_node followed_node(const dea_cards *c, size_t stress)
{
    return is_linear(c) ? (dea_stress_node){"u"} : mobility_stress_node(c->dynamics, stress);
}

/* The relaxed stresses of the branches follow the stress with their time constants. */
static void write_relaxations(const dea_cards *c)
{
    const size_t count = c->dynamics->branch_count;
    for (size_t k = 0; k < dea_dynamics_states(c->dynamics); k++) {
        const dea_stress_node stress = followed_node(c, k / count);
        const size_t n = k + 1;
        fprintf(c->out, "* branch %zu of the prony series: what it relaxes to, tau dz/dt = %s - z\n", n, is_linear(c) ? "u" : "S");
        fprintf(c->out, "GBRANCH%zu 0 z%zu %s z%zu 1\nCBRANCH%zu z%zu 0 {c_relax%zu}", n, n, stress.name, n, n, n, k % count + 1);
        if (c->form.cures) {
            fputc('\n', c->out);
        } else {
            fprintf(c->out, " ic={z_start%zu}\n", n);
        }
    }
}

/* B_a [S_a + sum c_i (S_a - z_ai)]. */
static void write_stress_force(const dea_cards *c, size_t a)
{
    const dea_stress_node stress = mobility_stress_node(c->dynamics, a);
    const size_t count = c->dynamics->branch_count;
    dea_part_text_write(&c->text, c->mobility->stresses[a].lever);
    fprintf(c->out, count > 0 ? "*(v(%s)" : "*v(%s)", stress.name);
    for (size_t i = 0; i < count; i++) {
        char branch[96];
        snprintf(branch, sizeof branch, "+[share%zu]*(v(%s)-v(z%zu))", i + 1, stress.name, a * count + i + 1);
        dea_part_text_format(&c->text, branch);
    }
    fputs(count > 0 ? ")" : "", c->out);
}

/* All of them and G against the motion. */
static void write_spring_force(dea_cards *c)
{
    fputs("* force of the film [N], its stresses and those of its branches on their levers [m^2]\n", c->out);
    begin_force(c, "SPRING", false);
    dea_part_text_format(&c->text, c->form.cures ? "[a_um]*(" : "");
    for (size_t a = 0; a < c->dynamics->stress_count; a++) {
        fputs(a > 0 ? "+" : "", c->out);
        write_stress_force(c, a);
    }
    if (c->mobility->tense) {
        dea_part_text_format(&c->text, "+[]", c->mobility->tension);
    }
    fputs(c->form.cures ? ")" : "", c->out);
    end_force(c);
}

void dea_cards_write_integral(const dea_cures *cures, const char *tag, const char *node, const char *from, const char *to, FILE *out)
{
    fprintf(out, "GDISP%s 0 %s %s %s %.15g\nCDISP%s %s 0 1\nGDRIFT%s %s 0 %s 0 %.15g\n",
            tag, node, from, to, cures->per_metre, tag, node, tag, node, node, cures->drift);
}

/* In a part the edge is held where a parameter is out of its range, and a hyperelastic film is asked for no displacement past stops
 * short of the centre and of the frame, where is no film. */
static void write_displacement(const dea_cards *c)
{
    if (!c->form.cures) {
        fputs("* displacement of the edge [m], the integral of its velocity\nGDISP 0 disp edge 0 1\nCDISP disp 0 1 ic={u_start}\n",
              c->out);
        return;
    }
    fputs("* displacement [um], the integral of the velocity, which leaks\n", c->out);
    dea_cards_write_integral(c->form.cures, "", "u", "edge", "0", c->out);
    fputs("GSAFE edge 0 u 0 {hold}\n", c->out);
    if (!is_linear(c)) {
        dea_part_text_source(&c->text, DEA_VOLTAGE, "CLIP", "w", "0", "min(max(v(u),[u_low]),[u_high])");
        fputs("GSTOP edge 0 u w {k_stop}\n", c->out);
    }
}

/* The springs of a part, of the relaxed film and of its branches [N/um], and its damper [N s/m]. */
static void write_conductances(const dea_cards *c)
{
    fputs("* springs of film and branches, damper\nGSPRING edge 0 u 0 {k_um}\nGDAMP edge 0 edge 0 {r_damp}\n", c->out);
    write_relaxations(c);
    for (size_t i = 1; i <= c->dynamics->branch_count; i++) {
        fprintf(c->out, "GHELD%zu edge 0 u z%zu {k_um%zu}\n", i, i, i);
    }
}

static void write_hyperelastic_springs(dea_cards *c)
{
    const dea_mobility *m = c->mobility;
    for (size_t a = 0; a < c->dynamics->stress_count; a++) {
        char name[32];
        const dea_stress_node node = mobility_stress_node(c->dynamics, a);
        snprintf(name, sizeof name, "STRESS%s", node.name + strlen("stress"));
        fprintf(c->out, "* stress S of the relaxed film [%s], its change from rest\n", c->form.cures ? "MPa" : "Pa");
        dea_part_text_source(&c->text, DEA_VOLTAGE, name, node.name, "0", "[]", m->stresses[a].stress);
    }
    write_relaxations(c);
    write_spring_force(c);
    if (c->dynamics->retardation > 0.0) {
        fputs("* kelvin-voigt damper, tau sum B dS/du times the velocity [N]\n", c->out);
        begin_force(c, "DAMPER", false);
        dea_part_text_format(&c->text, c->form.cures ? "[r_damp]*[]*" : "[retardation]*[]*", m->resistance);
        if (c->form.cures) {
            fprintf(c->out, "min(max(v(edge),-%.15g),%.15g)", c->form.cures->fastest, c->form.cures->fastest);
        } else {
            fputs("v(edge)", c->out);
        }
        end_force(c);
    }
}

static void write_hyperelastic_numbers(const dea_cards *c, const dea_mobility_state *start)
{
    const dea_dynamics *d = c->dynamics;
    if (!c->mobility->displaced) {
        dea_part_value(c->out, "u_start", start->u);
    }
    if (d->retardation > 0.0) {
        dea_part_value(c->out, "retardation", d->retardation);
    }
    for (size_t i = 0; i < d->branch_count; i++) {
        indexed(c, "c_relax", i + 1, d->branches[i].tau);
        indexed(c, "share", i + 1, d->branches[i].share);
    }
    for (size_t k = 0; k < dea_dynamics_states(d); k++) {
        indexed(c, "z_start", k + 1, start->z[k]);
    }
}

/* ---- the port */

static void write_resistors(dea_cards *c)
{
    if (c->dynamics->conductance > 0.0) {
        fputs("* leakage resistance of the film [Ohm]\nRLEAK film 0 {r_leak}\n", c->out);
    }
    if (isfinite(c->dynamics->limit)) {
        fputs("* series resistance of source and electrodes [Ohm] behind a source of no more than i_limit [A]\n", c->out);
        dea_part_text_source(&c->text, DEA_CURRENT, "SERIES", "source", "film",
                             "min([i_limit],max(-[i_limit],(v(source)-v(film))/[r_series]))");
    } else if (c->dynamics->series > 0.0) {
        fputs("* series resistance of source and electrodes [Ohm]\nRSERIES source film {r_series}\n", c->out);
    }
}

static void write_resistor_numbers(const dea_cards *c, double unit)
{
    if (c->dynamics->conductance > 0.0) {
        dea_part_value(c->out, "r_leak", unit / c->dynamics->conductance);
    }
    if (c->dynamics->series > 0.0) {
        dea_part_value(c->out, "r_series", unit * c->dynamics->series);
    }
    if (isfinite(c->dynamics->limit)) {
        dea_part_value(c->out, "i_limit", c->dynamics->limit / unit);
    }
}

void dea_cards_write_capacitor(const dea_cures *cures, FILE *out)
{
    fprintf(out, "CFILM film plate {c_rest}\nGSENSE plate 0 plate 0 %.15g\nGFILM p n plate 0 {i_film}\n"
                 "* conductance of the leakage [S], 0 without a resistance\nGLEAK p n p n {leak}\n",
            cures->sense);
}

/* The film of a part: its current is that of a capacitor, without a gain, so that what a simulator adds to nodes and pivots (gmin,
 * rshunt, cshunt) stays what it is. v(plate) makes it a voltage; fed back into v(film), it leaves the capacitor its whole voltage. A
 * conductance has no noise, as a resistor would. The force is a node to be read. */
static void write_part_film(dea_cards *c)
{
    fputs("* film: v(film) = charge/c_rest on a capacitor of c_rest, whose current is d(C U)/dt; v(plate) is this current [mA]\n", c->out);
    dea_part_text_source(&c->text, DEA_VOLTAGE, "CHARGE", "film", "0", "v(plate)+[ok]*v(p,n)*[]/[c_rest]",
                         c->mobility->network.capacitance);
    dea_cards_write_capacitor(c->form.cures, c->out);
    fputs("* electrostatic force [N] onto the edge, (1/2) U^2 dC/du, Eq. 21\n", c->out);
    dea_part_text_source(&c->text, DEA_VOLTAGE, "FORCE", "force", "0", "[ok]*[]*v(p,n)*v(p,n)", c->mobility->push);
    fputs("GFORCE 0 edge force 0 {many}\n", c->out);
}

/* Behind a resistance the charge is a state: the integral of the film's current, whose voltage is that charge over C(u). */
static void write_film(dea_cards *c)
{
    if (c->dynamics->series > 0.0) {
        fputs("* film: its current into its capacitance at rest [F], whose charge over C(u) is its voltage, i = d(C U)/dt\n"
              "VFILM film plate 0\nFCHARGE 0 charge VFILM 1\nCCHARGE charge 0 {c_unit} ic={u_rest}\n",
              c->out);
        dea_part_text_source(&c->text, DEA_VOLTAGE, "FILM", "plate", "0", "v(charge)*[c_rest]/([])", c->mobility->network.capacitance);
    }
    fputs("* electrostatic force f_dea = U^2/2 dC/du [N], Eq. 21, onto the edge\n", c->out);
    begin_force(c, "FORCE", true);
    dea_part_text_format(&c->text, "[]*v(film)*v(film)", c->mobility->push);
    end_force(c);
}

static void write_port_numbers(const dea_cards *c, const dea_cards_numbers *n)
{
    write_resistor_numbers(c, n->unit);
    if (c->dynamics->series > 0.0) {
        dea_part_value(c->out, "c_rest", c->mobility->rest);
        dea_part_value(c->out, "c_unit", c->mobility->rest / n->unit);
        dea_part_value(c->out, "u_rest", n->start.charge / c->mobility->rest);
    }
}

/* ---- a transient */

/* Every expression that a card writes, as often as it does. */
void dea_cards_declare(dea_cards *c)
{
    const dea_mobility *m = c->mobility;
    dea_part_text_call(&c->text, &m->network);
    dea_part_text_root(&c->text, "push");
    dea_part_text_use(&c->text, m->push);
    if (c->dynamics->series > 0.0 || c->form.cures) {
        dea_part_text_root(&c->text, "capacity");
        dea_part_text_use(&c->text, m->network.capacitance);
    }
    for (size_t a = 0; a < c->dynamics->stress_count && !is_linear(c); a++) {
        const dea_stress_node node = mobility_stress_node(c->dynamics, a);
        dea_part_text_root(&c->text, node.name);
        dea_part_text_use(&c->text, m->stresses[a].stress);
        dea_part_text_root(&c->text, "lever");
        dea_part_text_use(&c->text, m->stresses[a].lever);
    }
    if (!is_linear(c) && m->tense) {
        dea_part_text_root(&c->text, "tension");
        dea_part_text_use(&c->text, m->tension);
    }
    if (!is_linear(c) && c->dynamics->retardation > 0.0) {
        dea_part_text_root(&c->text, "damping");
        (c->form.cures ? dea_part_text_use_as_factor : dea_part_text_use)(&c->text, m->resistance);
    }
}

static void evaluate(const dea_cards *c, double u)
{
    const dea_quantities *q = &c->mobility->quantities;
    dea_pool_values_at(&c->mobility->network.pool, &(dea_point_values){q->values, &u, q->count + 1, 1}, c->values);
}

bool dea_cards_open(const dea_mobility *mobility, const dea_cards_form *form, FILE *out, dea_cards *cards)
{
    const dea_pool *pool = &mobility->network.pool;
    const dea_quantities *q = &mobility->quantities;
    *cards = (dea_cards){.form = *form, .out = out, .mobility = mobility, .dynamics = mobility->dynamics};
    cards->values = calloc((size_t)pool->count + 1, sizeof *cards->values);
    cards->symbols = calloc((size_t)q->count + 1, sizeof *cards->symbols);
    if (!dea_part_text_open(&cards->text, pool, form->dialect, out) || !cards->values || !cards->symbols) {
        return false;
    }
    for (int i = 0; i <= q->count; i++) {
        cards->symbols[i] = q->names[i];
    }
    const bool flux = is_linear(cards) && !form->analogy->loop;
    if (form->cures) {
        snprintf(cards->node, sizeof cards->node, "(%.15g*v(%s))", 1.0 / form->cures->per_metre, flux ? "u" : "w");
    } else {
        snprintf(cards->node, sizeof cards->node, flux ? "(%sn_spring%s*i(LSPRING))" : "v(disp)", form->dialect->left,
                 form->dialect->right);
    }
    cards->text.node = cards->node;
    cards->text.symbols = cards->symbols;
    if (form->numbers) {
        evaluate(cards, 0.0);
        cards->text.values = cards->values;
    }
    if (!form->cures) { /* all nodes are given their values at the start */
        dea_part_text_share(&cards->text);
    }
    return true;
}

void dea_cards_close(dea_cards *cards)
{
    dea_part_text_close(&cards->text);
    free(cards->values);
    free(cards->symbols);
}

void dea_cards_write_quantities(const dea_quantities *q, FILE *out)
{
    for (int i = 1; i <= q->count; i++) {
        dea_part_value(out, q->names[i], q->values[i]);
    }
}

void dea_cards_write_numbers(dea_cards *c, const dea_cards_numbers *n)
{
    if (!c->form.numbers) {
        dea_cards_write_quantities(&c->mobility->quantities, c->out);
    }
    dea_part_text_parameters(&c->text);
    write_port_numbers(c, n);
    if (is_linear(c)) {
        write_linear_numbers(c, c->mobility->stiffness, c->mobility->stiffness, &n->start);
    } else {
        write_hyperelastic_numbers(c, &n->start);
    }
    write_mass_numbers(c, c->dynamics->mass > 0.0 ? n->mass : 0.0);
    if (c->dynamics->mass > 0.0) {
        dea_part_value(c->out, "v_start", n->start.v);
    }
}

void dea_cards_write_network(dea_cards *c)
{
    fputs(DEA_CARDS_BEGIN, c->out);
    for (int i = 0; i < c->mobility->network.element_count && !c->form.cures; i++) {
        const dea_element *element = &c->mobility->network.elements[i];
        fprintf(c->out, "* %s%s: %s\n", element->second ? "second film, " : "", element->name, element->meaning);
    }
    dea_part_text_nodes(&c->text); /* the sources refer to them */
    write_resistors(c);
    (c->form.cures ? write_part_film : write_film)(c);
    if (c->form.cures || !(is_linear(c) || c->mobility->displaced)) {
        write_displacement(c);
    }
    if (!is_linear(c)) {
        write_hyperelastic_springs(c);
    } else if (c->form.cures) {
        write_conductances(c);
    } else {
        write_linear_springs(c);
    }
    write_mass(c);
    write_load(c);
    close_loop(c);
    fputs(DEA_CARDS_END, c->out);
}

/* Film voltage that goes with the start [V]. */
static double cards_film_voltage(dea_cards *c, const dea_cards_numbers *n, double source)
{
    if (!(c->dynamics->series > 0.0)) {
        return source;
    }
    evaluate(c, n->start.u);
    return n->start.charge / c->values[c->mobility->network.capacitance];
}

static void start_node(const dea_cards *c, const char *node, double value)
{
    dea_part_print(c->out, " v(%s)=%g", node, value);
}

void dea_cards_write_start(dea_cards *c, const dea_cards_numbers *n, double source)
{
    const dea_mobility *m = c->mobility;
    const dea_mobility_state *start = &n->start;
    const double voltage = cards_film_voltage(c, n, source);
    evaluate(c, start->u);
    start_node(c, "film", voltage);
    if (c->dynamics->series > 0.0) {
        start_node(c, "plate", voltage);
        start_node(c, "charge", start->charge / m->rest);
    }
    if (!m->displaced) {
        start_node(c, "edge", start->v);
    }
    dea_part_text_start(&c->text, "", c->values);
    if (!is_linear(c) || c->form.analogy->loop) {
        start_node(c, "disp", start->u);
    }
    for (size_t a = 0; a < c->dynamics->stress_count && !is_linear(c); a++) {
        start_node(c, mobility_stress_node(c->dynamics, a).name, c->values[m->stresses[a].stress]);
    }
    for (size_t i = 0; i < dea_dynamics_states(c->dynamics) && !is_linear(c); i++) {
        char name[24];
        snprintf(name, sizeof name, "z%zu", i + 1);
        start_node(c, name, start->z[i]);
    }
}

/* ---- small signals */

void dea_cards_write_small(dea_dynamics *d, const dea_mobility_bias *bias, const dea_cards_form *form, FILE *out)
{
    dea_cards c = {.form = *form, .out = out, .dynamics = d};
    const dea_edge e = dea_dynamics_edge(d, bias->u);
    write_resistor_numbers(&c, 1.0);
    dea_part_value(out, "c_film", e.capacitance);
    dea_part_value(out, "transduction", 2.0 * e.push * bias->voltage);
    write_linear_numbers(&c, dea_dynamics_stiffness(d, bias->u, bias->voltage, true), dea_edge_viscous(d, &e), NULL);
    write_mass_numbers(&c, d->mass);
    fputs(DEA_CARDS_BEGIN, out);
    write_resistors(&c);
    fputs("* capacitance of the film at the bias [F]\nCFILM film 0 {c_film}\n"
          "* transduction dF/dU = dq/du = 2 phi U [N/V] = [A s/m], Eq. 21: force onto the edge, current into the film\n",
          out);
    fputs(form->analogy->loop ? "EFORCE m0 0 film 0 {transduction}\nFCURRENT film 0 VLOOP {transduction}\n"
                              : "GFORCE 0 edge film 0 {transduction}\nGCURRENT film 0 edge 0 {transduction}\n",
          out);
    fputs("* springs of the relaxed film at the bias and of the voltage\n", out);
    write_linear_springs(&c);
    write_mass(&c);
    write_load(&c);
    close_loop(&c);
    fputs(DEA_CARDS_END, out);
}

void dea_cards_write_band(const dea_mobility_band *band, FILE *out)
{
    if (band->points_per_decade > 0) {
        fprintf(out, ".ac dec %zu ", band->points_per_decade);
    } else {
        fprintf(out, ".ac lin %zu ", band->count > 1 ? band->count : 1);
    }
    dea_part_print(out, "%g %g\n.end\n", band->from, band->to);
}
