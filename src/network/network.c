#include "network/network.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "expression/derivative.h"
#include "film/edge.h"
#include "film/second.h"
#include "material/form.h"

void dea_network_free(dea_network *network)
{
    if (network) {
        dea_pool_free(&network->pool);
        free(network->elements);
        free(network->named);
        free(network->tension);
        free(network->range);
        network->elements = NULL;
        network->named = NULL;
        network->tension = network->range = NULL;
    }
}

static void add_element(dea_network *network, dea_element element)
{
    const size_t count = (size_t)network->element_count;
    dea_element *elements = realloc(network->elements, (count + 1) * sizeof *elements);
    if (!elements) {
        network->pool.exhausted = true;
        return;
    }
    elements[network->element_count++] = element;
    network->elements = elements;
}

void dea_network_add(dea_network *network, dea_role role, const char *name, const char *meaning, dea_expr value)
{
    add_element(network, (dea_element){role, name, meaning, false, value, 0});
}

void dea_network_add_stress(dea_network *network, const char *name, const char *meaning, dea_expr stress, dea_expr lever)
{
    add_element(network, (dea_element){DEA_ROLE_HYPERELASTIC, name, meaning, false, stress, lever});
}

void dea_network_call(dea_network *network, dea_expr ref, const char *name, const char *meaning)
{
    dea_named_term *named = realloc(network->named, ((size_t)network->named_count + 1) * sizeof *named);
    if (!named) {
        network->pool.exhausted = true;
        return;
    }
    named[network->named_count++] = (dea_named_term){ref, name, meaning};
    network->named = named;
}

void dea_network_gather(dea_network *network)
{
    dea_pool *pool = &network->pool;
    for (int i = 0; i < network->element_count; i++) {
        dea_element *element = &network->elements[i];
        element->value = dea_expr_gathered(pool, element->value);
        element->lever = element->role == DEA_ROLE_HYPERELASTIC ? dea_expr_gathered(pool, element->lever) : element->lever;
    }
    for (int i = 0; i < network->named_count; i++) {
        network->named[i].ref = dea_expr_gathered(pool, network->named[i].ref);
    }
    network->capacitance = dea_expr_gathered(pool, network->capacitance);
}

/* One more expression at the end of a list. */
static void append(dea_network *network, dea_expr **list, int *count, dea_expr ref)
{
    dea_expr *longer = realloc(*list, ((size_t)*count + 1) * sizeof *longer);
    if (!longer) {
        network->pool.exhausted = true;
        return;
    }
    longer[(*count)++] = ref;
    *list = longer;
}

void dea_network_taut(dea_network *network, dea_expr tension)
{
    append(network, &network->tension, &network->tension_count, tension);
}

/* Something that is positive where the point makes sense. */
static void network_demand(dea_network *network, dea_expr range)
{
    append(network, &network->range, &network->range_count, range);
}

void dea_network_insulate(const dea_symbols *symbols, dea_network *network, dea_expr l1, dea_expr l2)
{
    if (dea_expr_constant(symbols->pool, symbols->electrostriction) != 0.0) {
        network_demand(network, dea_symbols_electric(symbols, l1, l2).own);
    }
}

void dea_network_limit_area(const dea_symbols *symbols, dea_network *network)
{
    dea_pool *pool = symbols->pool;
    const dea_expr one = NUM(1.0);
    const dea_expr stretch = ADD(one, network->strain);
    dea_expr area = SQUARE(stretch);
    if (symbols->kind == DEA_LENS) {
        const dea_expr edge = SQUARE(MUL(symbols->coverage, stretch));
        area = DIV(SUB(one, edge), SUB(one, SQUARE(symbols->coverage)));
    }
    const dea_expr rest = MUL(dea_symbols_nominal_field(symbols), SQUARE(symbols->prestretch));
    network->field = MUL(rest, area);
    dea_network_insulate(symbols, network, area, one);
}

/* A scalar of the scene: symbol 0 where it is the axis, else its number. */
static dea_expr scalar(dea_pool *pool, const dea_scene *scene, const dea_axis *axis, const double *field)
{
    const size_t offset = (size_t)((const char *)field - (const char *)scene);
    return axis && axis->offset == offset ? dea_expr_symbol(pool, 0) : NUM(*field);
}

static bool given(const dea_pool *pool, dea_expr ref)
{
    return pool->terms[ref].varies || !isnan(dea_expr_constant(pool, ref));
}

/* dea_material_long_term_share(). */
static dea_expr long_term_share(dea_pool *pool, const dea_scene *scene, const dea_axis *axis)
{
    dea_expr share = NUM(1.0);
    if (scene->material.instantaneous) {
        for (size_t i = 0; i < scene->material.prony_count; i++) {
            share = SUB(share, scalar(pool, scene, axis, &scene->material.prony[i].g));
        }
    }
    const dea_expr temperature = scalar(pool, scene, axis, &scene->material.temperature);
    const dea_expr slope = scalar(pool, scene, axis, &scene->material.modulus_slope);
    if (given(pool, temperature) && given(pool, slope)) {
        const dea_expr above = SUB(temperature, scalar(pool, scene, axis, &scene->material.modulus_reference));
        share = MUL(share, ADD(NUM(1.0), MUL(slope, above)));
    }
    return share;
}

/* What the sheets of the electrodes add to the series resistance: dea_sheet_share(). */
static dea_expr sheet_resistance(dea_pool *pool, const dea_scene *scene, const dea_axis *axis, dea_expr b, dea_expr layers)
{
    const dea_expr sheet = scalar(pool, scene, axis, &scene->electrode.sheet_resistance), b2 = SQUARE(b);
    dea_expr share = NUM(0.125 / DEA_PI);
    if (scene->actuator.kind == DEA_LENS && !isnan(dea_expr_constant(pool, b))) {
        share = NUM(dea_sheet_share(DEA_LENS, dea_expr_constant(pool, b), 1.0) / 2.0);
    } else if (scene->actuator.kind == DEA_LENS) {
        const dea_expr x = SUB(NUM(1.0), b2);
        const dea_expr rest = SUB(SCALE(0.25, MUL(x, SUB(NUM(1.0), SCALE(3.0, b2)))), MUL(SQUARE(b2), LN(b)));
        share = SCALE(0.5 / DEA_PI, DIV(rest, SQUARE(x)));
    }
    return MUL(MUL(sheet, share), DIV(SUB(SCALE(4.0, layers), NUM(2.0)), SQUARE(layers)));
}

/* Source voltage, less what a leaking film leaves on the series resistance. */
static dea_expr film_voltage(dea_pool *pool, const dea_scene *scene, const dea_axis *axis, const dea_symbols *s)
{
    const dea_expr source = scalar(pool, scene, axis, &scene->drive.voltage);
    const dea_expr leakage = scalar(pool, scene, axis, &scene->drive.leakage_resistance);
    dea_expr series = scalar(pool, scene, axis, &scene->drive.series_resistance);
    if (scene->electrode.sheet_resistance > 0.0) {
        const dea_expr sheet = sheet_resistance(pool, scene, axis, s->coverage, s->layers);
        series = given(pool, series) ? ADD(series, sheet) : sheet;
    }
    if (!given(pool, series) || !given(pool, leakage)) {
        return source;
    }
    return MUL(source, DIV(leakage, ADD(series, leakage)));
}

/* A law at two stretches. */
static dea_law_form form_of(dea_pool *pool, const dea_law *law, const dea_expr *constants, dea_expr l1, dea_expr l2)
{
    dea_law_form form = {0};
    if (!pool->exhausted) {
        law->form(pool, constants, l1, l2, &form);
    }
    return form;
}

static dea_law_form form_at(const dea_symbols *symbols, dea_expr l1, dea_expr l2)
{
    return form_of(symbols->pool, symbols->law, symbols->constants, l1, l2);
}

dea_expr dea_symbols_rest_stress(const dea_symbols *symbols)
{
    return form_at(symbols, symbols->prestretch, symbols->prestretch).stress[0];
}

/* dsigma/dlambda at an equi-biaxial stretch. */
static dea_expr modulus_at(dea_pool *pool, const dea_law *law, const dea_expr *constants, dea_expr stretch)
{
    const dea_expr l = dea_expr_node(pool, 0);
    return dea_expr_put(pool, dea_expr_slope(pool, form_of(pool, law, constants, l, l).stress[0]), DEA_NODE, 0, stretch);
}

dea_expr dea_symbols_modulus(const dea_symbols *symbols)
{
    return modulus_at(symbols->pool, symbols->law, symbols->constants, symbols->prestretch);
}

dea_expr dea_symbols_skin_modulus(const dea_symbols *symbols)
{
    dea_pool *pool = symbols->pool;
    return MUL(MUL(symbols->skin_share, symbols->prestretch), modulus_at(pool, symbols->skin, symbols->skin_constants, NUM(1.0)));
}

/* P1 = sigma_1/l1, so that W11 = (dsigma_1/dl1 - sigma_1/l)/l and W12 = dsigma_1/dl2/l at l1 = l2 = l. */
static dea_tangent tangent_at(dea_pool *pool, const dea_law *law, const dea_expr *constants, dea_expr l)
{
    const dea_expr stress = form_of(pool, law, constants, dea_expr_node(pool, 0), dea_expr_node(pool, 1)).stress[0];
    dea_expr slope[2];
    for (int i = 0; i < 2; i++) {
        const dea_expr over = dea_expr_derivative(pool, stress, DEA_NODE, i);
        slope[i] = dea_expr_put(pool, over, DEA_NODE, -1, l);
    }
    const dea_expr along = SUB(slope[0], DIV(form_of(pool, law, constants, l, l).stress[0], l));
    return (dea_tangent){DIV(along, l), DIV(slope[1], l)};
}

dea_tangent dea_symbols_tangent(const dea_symbols *symbols)
{
    return tangent_at(symbols->pool, symbols->law, symbols->constants, symbols->prestretch);
}

dea_tangent dea_symbols_skin_tangent(const dea_symbols *symbols)
{
    dea_pool *pool = symbols->pool;
    const dea_tangent skin = tangent_at(pool, symbols->skin, symbols->skin_constants, NUM(1.0));
    return (dea_tangent){MUL(symbols->skin_share, skin.w11), MUL(symbols->skin_share, skin.w12)};
}

/* The skin of the electrodes, if there is one. */
static void coat(const dea_scene *scene, const dea_axis *axis, dea_symbols *s)
{
    const dea_electrode *electrode = &scene->electrode;
    dea_pool *pool = s->pool;
    s->skin = electrode->law;
    for (size_t i = 0; i < DEA_LAW_CONSTANTS && s->skin; i++) {
        s->skin_constants[i] = scalar(pool, scene, axis, &electrode->constants[i]);
    }
    s->skin_share = s->skin ? DIV(scalar(pool, scene, axis, &electrode->thickness), s->film_thickness) : NUM(0.0);
}

dea_symbols dea_symbols_of(const dea_scene *scene, const dea_axis *axis, dea_pool *pool)
{
    const dea_actuator *actuator = &scene->actuator;
    const dea_material *material = &scene->material;
    const dea_expr share = long_term_share(pool, scene, axis);
    dea_symbols s = {.pool = pool, .kind = actuator->kind};
    s.frame_radius = scalar(pool, scene, axis, &actuator->frame_radius);
    const dea_expr divide = scalar(pool, scene, axis, &actuator->divide_radius);
    s.coverage = given(pool, divide) ? DIV(divide, s.frame_radius) : scalar(pool, scene, axis, &actuator->coverage);
    s.layers = scalar(pool, scene, axis, &actuator->layers);
    s.film_thickness = MUL(s.layers, scalar(pool, scene, axis, &actuator->film_thickness));
    s.prestretch = scalar(pool, scene, axis, &actuator->prestretch);
    s.law = material->law;
    for (size_t i = 0; i < DEA_LAW_CONSTANTS; i++) {
        const dea_expr constant = scalar(pool, scene, axis, &material->constants[i]);
        s.constants[i] = s.law->constants[i % s.law->constant_count].modulus ? MUL(share, constant) : constant;
    }
    const dea_expr modulus = scalar(pool, scene, axis, &material->modulus);
    s.modulus = given(pool, modulus) ? MUL(share, modulus) : dea_symbols_modulus(&s);
    const dea_expr slope = scalar(pool, scene, axis, &material->permittivity_per_stretch);
    const dea_expr relative = ADD(scalar(pool, scene, axis, &material->permittivity), MUL(slope, s.prestretch));
    s.permittivity = MUL(SCALE(DEA_EPSILON_0, relative), SQUARE(s.layers));
    s.electrostriction = material->permittivity_follows ? DIV(slope, relative) : NUM(0.0);
    const dea_expr breakdown = scalar(pool, scene, axis, &material->breakdown);
    s.breakdown = given(pool, breakdown) ? breakdown : NUM(INFINITY);
    coat(scene, axis, &s);
    for (size_t i = 0; i < DEA_LOADS; i++) {
        const dea_edge_load *load = &scene->loads[i];
        s.load_kinds[i] = dea_load_is_given(load) && load->kind->element ? load->kind : NULL;
        s.loads[i] = s.load_kinds[i] ? scalar(pool, scene, axis, &load->number) : NUM(0.0);
        s.loaded = s.loaded || dea_expr_constant(pool, s.loads[i]) != 0.0;
    }
    s.voltage = film_voltage(pool, scene, axis, &s);
    s.focal_length = scalar(pool, scene, axis, &actuator->focal_length);
    s.refractive_index = scalar(pool, scene, axis, &actuator->refractive_index);
    return s;
}

dea_expr dea_symbols_nominal_field(const dea_symbols *symbols)
{
    dea_pool *pool = symbols->pool;
    return MUL(symbols->layers, DIV(symbols->voltage, symbols->film_thickness));
}

dea_expr dea_symbols_pressure(const dea_symbols *symbols)
{
    dea_pool *pool = symbols->pool;
    return MUL(symbols->permittivity, SQUARE(DIV(symbols->voltage, symbols->film_thickness)));
}

dea_symbols_factors dea_symbols_electric(const dea_symbols *symbols, dea_expr l1, dea_expr l2)
{
    dea_pool *pool = symbols->pool;
    if (dea_expr_constant(pool, symbols->electrostriction) == 0.0) {
        return (dea_symbols_factors){NUM(1.0), NUM(1.0), NUM(1.0)};
    }
    const dea_expr mean = l1 == l2 ? l1 : SQRT(MUL(l1, l2));
    const dea_expr one = NUM(1.0), rise = MUL(symbols->electrostriction, symbols->prestretch); /* of eps over that at rest */
    const dea_expr own = ADD(one, MUL(rise, SUB(mean, one)));
    return (dea_symbols_factors){own, ADD(own, SCALE(0.25, MUL(rise, mean))), ADD(own, SCALE(0.875, MUL(rise, mean)))};
}

dea_expr dea_symbols_stress_per_volt(const dea_symbols *symbols)
{
    dea_pool *pool = symbols->pool;
    const dea_expr electric = dea_symbols_electric(symbols, NUM(1.0), NUM(1.0)).first;
    return MUL(MUL(symbols->permittivity, electric), SQUARE(DIV(SQUARE(symbols->prestretch), symbols->film_thickness)));
}

dea_expr dea_symbols_capacitance(const dea_symbols *symbols)
{
    dea_pool *pool = symbols->pool;
    const dea_expr b2 = SQUARE(symbols->coverage);
    const dea_expr share = symbols->kind == DEA_DOT ? b2 : SUB(NUM(1.0), b2);
    const dea_expr area = SCALE(DEA_PI, MUL(SQUARE(symbols->frame_radius), share));
    return MUL(MUL(symbols->permittivity, DIV(SQUARE(symbols->prestretch), symbols->film_thickness)), area);
}

static dea_expr divide_radius(const dea_symbols *symbols)
{
    return dea_expr_mul(symbols->pool, symbols->frame_radius, symbols->coverage);
}

dea_expr dea_symbols_cross_section(const dea_symbols *symbols)
{
    dea_pool *pool = symbols->pool;
    const dea_expr circumference = SCALE(2.0 * DEA_PI, divide_radius(symbols));
    return MUL(circumference, DIV(symbols->film_thickness, SQUARE(symbols->prestretch)));
}

/* Radial strain of the disc, u/r_a [1]. */
static dea_expr symbols_disc_strain(const dea_symbols *symbols)
{
    return dea_expr_div(symbols->pool, dea_expr_node(symbols->pool, 0), divide_radius(symbols));
}

dea_expr dea_symbols_annulus_width(const dea_symbols *symbols)
{
    dea_pool *pool = symbols->pool;
    return MUL(symbols->frame_radius, SUB(NUM(1.0), symbols->coverage));
}

dea_expr dea_symbols_annulus_strain(const dea_symbols *symbols)
{
    return dea_expr_neg(symbols->pool,
                        dea_expr_div(symbols->pool, dea_expr_node(symbols->pool, 0), dea_symbols_annulus_width(symbols)));
}

/* What every network has, whatever its elements: coordinates, limits, ranges. */
static void place_edge(const dea_symbols *symbols, dea_network *network)
{
    dea_pool *pool = symbols->pool;
    const dea_expr one = NUM(1.0);
    network->edge = dea_expr_node(pool, 0);
    network->strain = symbols_disc_strain(symbols);
    network->kind = symbols->kind;
    network->sign = symbols->kind == DEA_DOT ? 1.0 : -1.0;
    network->voltage = symbols->voltage;
    network->coverage = symbols->coverage;
    network->radius = divide_radius(symbols);
    network->focal_length = symbols->focal_length;
    network->refractive_index = symbols->refractive_index;
    network->length = MUL(divide_radius(symbols), SUB(one, symbols->coverage)); /* below both r_a and r - r_a */
    network_demand(network, symbols->coverage);
    network_demand(network, SUB(one, symbols->coverage));
    network_demand(network, symbols->permittivity);
    network_demand(network, dea_symbols_electric(symbols, one, one).first);
    network_demand(network, modulus_at(pool, symbols->law, symbols->constants, one)); /* three times the shear modulus, twice over */
    network_demand(network, form_at(symbols, symbols->prestretch, symbols->prestretch).room);
    if (symbols->skin) {
        network_demand(network, symbols->skin_share);
        network_demand(network, modulus_at(pool, symbols->skin, symbols->skin_constants, one));
    }
    network->breakdown = symbols->breakdown;
}

/* An element of the second film: its springs relax as those of the first or are elastic beside them, what its voltage does is steady. */
static dea_element as_second(const dea_symbols *symbols, const dea_network *second, dea_element element)
{
    dea_pool *pool = symbols->pool;
    element.second = true;
    if (element.role == DEA_ROLE_SPRING && !symbols->relaxes) {
        element.role = DEA_ROLE_BESIDE;
    } else if (element.role == DEA_ROLE_HYPERELASTIC && !symbols->relaxes) {
        element.role = DEA_ROLE_TENSION;
        element.value = MUL(element.lever, element.value);
    } else if (element.role == DEA_ROLE_SOFTENING) {
        element.role = DEA_ROLE_STEADY;
        element.value = NEG(MUL(element.value, second->edge));
    } else if (element.role == DEA_ROLE_SOURCE) {
        element.role = DEA_ROLE_STEADY;
    }
    return element;
}

/* The other film on the same edge: u is that of both. */
static void add_second(const dea_symbols *symbols, const dea_model *model, dea_network *network)
{
    dea_network second = {0};
    place_edge(symbols, &second);
    model->network(symbols, &second);
    for (int i = 0; i < second.element_count; i++) {
        add_element(network, as_second(symbols, &second, second.elements[i]));
    }
    for (int i = 0; i < second.tension_count; i++) {
        dea_network_taut(network, second.tension[i]);
    }
    for (int i = 0; i < second.range_count; i++) {
        network_demand(network, second.range[i]);
    }
    network->second_field = second.field;
    network->second_breakdown = second.breakdown;
    network->pool.exhausted = network->pool.exhausted || second.pool.exhausted;
    dea_network_free(&second);
}

dea_expr dea_symbols_springs(const dea_symbols *symbols, dea_expr u)
{
    dea_pool *pool = symbols->pool;
    dea_expr sum = NUM(0.0);
    for (size_t i = 0; i < DEA_LOADS; i++) {
        const dea_load_kind *kind = symbols->load_kinds[i];
        sum = kind ? ADD(sum, MUL(SCALE(kind->adds.stiffness, symbols->loads[i]), u)) : sum;
        sum = kind && kind->spring ? ADD(sum, kind->form(pool, symbols->loads[i], u)) : sum;
    }
    return sum;
}

dea_expr dea_symbols_force(const dea_symbols *symbols)
{
    dea_pool *pool = symbols->pool;
    dea_expr sum = NUM(0.0);
    for (size_t i = 0; i < DEA_LOADS; i++) {
        const dea_load_kind *kind = symbols->load_kinds[i];
        sum = kind ? ADD(sum, SCALE(kind->adds.force, symbols->loads[i])) : sum;
    }
    return sum;
}

/* What a load adds in one role, if anything. */
static void add_load(dea_network *network, const dea_load_kind *kind, dea_role role, dea_expr value)
{
    if (dea_expr_constant(&network->pool, value) != 0.0) {
        dea_network_add(network, role, kind->element, kind->meaning, value);
    }
}

static void add_loads(const dea_symbols *symbols, dea_network *network)
{
    dea_pool *pool = symbols->pool;
    for (size_t i = 0; i < DEA_LOADS; i++) {
        const dea_load_kind *kind = symbols->load_kinds[i];
        if (kind) {
            add_load(network, kind, DEA_ROLE_BESIDE, SCALE(kind->adds.stiffness, symbols->loads[i]));
            add_load(network, kind, DEA_ROLE_STEADY, SCALE(kind->adds.force, symbols->loads[i]));
            add_load(network, kind, DEA_ROLE_TENSION, kind->spring ? kind->form(pool, symbols->loads[i], network->edge) : NUM(0.0));
        }
    }
}

dea_status dea_network_build_symbols(const dea_symbols *symbols, const dea_model *model, dea_network *network, dea_error *error)
{
    dea_pool *pool = symbols->pool;
    place_edge(symbols, network);
    model->network(symbols, network);
    network->second_field = NUM(0.0);
    network->second_breakdown = NUM(INFINITY);
    if (symbols->second) {
        add_second(symbols->second, model, network);
    }
    add_loads(symbols, network);
    if (network->pool.exhausted) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a network is built");
    }
    return DEA_OK;
}

void dea_constant_name(const dea_law *law, size_t index, char name[DEA_QUANTITY_NAME])
{
    char number[24] = "";
    if (law->entries > 1) {
        snprintf(number, sizeof number, "%zu", index / law->constant_count + 1);
    }
    snprintf(name, DEA_QUANTITY_NAME, "%s%s", law->constants[index % law->constant_count].name, number);
    for (char *c = name; *c; c++) {
        *c = (char)tolower((unsigned char)*c);
    }
}

const char *dea_load_parameter(const dea_load_kind *kind, char name[DEA_QUANTITY_NAME])
{
    snprintf(name, DEA_QUANTITY_NAME, "load_%s", kind->name);
    return name;
}

/* Makes a number a symbol; 0 stays, so that it vanishes. */
static void lift(dea_quantities *quantities, dea_pool *pool, const char *whose, const char *name, dea_expr *field)
{
    const double value = dea_expr_constant(pool, *field);
    if (isfinite(value) && value != 0.0 && quantities->count < DEA_QUANTITIES) {
        const int symbol = ++quantities->count;
        snprintf(quantities->names[symbol], DEA_QUANTITY_NAME, "%s%.*s", whose, DEA_QUANTITY_NAME - 8, name);
        quantities->values[symbol] = value;
        *field = dea_expr_symbol(pool, symbol);
    }
}

/* Moduli of a law: of a film, "", of its skin or of the second film. */
static void lift_law(dea_quantities *quantities, dea_pool *pool, const dea_law *law, const char *whose, dea_expr *constants)
{
    char name[DEA_QUANTITY_NAME];
    for (size_t i = 0; i < DEA_LAW_CONSTANTS; i++) {
        if (law->constants[i % law->constant_count].modulus) {
            dea_constant_name(law, i, name);
            lift(quantities, pool, whose, name, &constants[i]);
        }
    }
}

static void lift_all(dea_quantities *quantities, dea_symbols *s, const char *whose, bool modulus)
{
    lift(quantities, s->pool, whose, "frame_radius", &s->frame_radius);
    lift(quantities, s->pool, whose, "film_thickness", &s->film_thickness);
    lift(quantities, s->pool, whose, "permittivity", &s->permittivity);
    if (dea_expr_constant(s->pool, s->voltage) != 1.0) { /* 1 V where a text multiplies by that of the film */
        lift(quantities, s->pool, whose, "voltage", &s->voltage);
    }
    for (size_t i = 0; i < DEA_LOADS; i++) {
        char name[DEA_QUANTITY_NAME];
        if (s->load_kinds[i]) {
            lift(quantities, s->pool, whose, dea_load_parameter(s->load_kinds[i], name), &s->loads[i]);
        }
    }
    lift_law(quantities, s->pool, s->law, whose, s->constants);
    if (s->skin) {
        lift_law(quantities, s->pool, s->skin, "skin_", s->skin_constants);
    }
    if (modulus) {
        lift(quantities, s->pool, whose, "modulus", &s->modulus);
    } else {
        s->modulus = dea_symbols_modulus(s);
    }
}

/* Symbols of the second film, whose frame is that of the first. */
static dea_symbols second_symbols(const dea_scene *scene, const dea_axis *axis, const dea_symbols *first, dea_quantities *quantities)
{
    dea_scene other;
    dea_axis moved;
    dea_second_scene(scene, &other);
    const dea_axis *own = axis && dea_second_axis(scene, axis, &moved) ? &moved : NULL;
    dea_symbols second = dea_symbols_of(&other, own, first->pool);
    second.frame_radius = first->frame_radius;
    second.coverage = first->coverage;
    if (quantities) {
        lift_all(quantities, &second, "second_", given(first->pool, scalar(first->pool, &other, own, &other.material.modulus)));
    }
    second.loaded = true;
    second.relaxes = dea_second_relaxes(scene);
    return second;
}

static dea_status build(const dea_scene *scene, const dea_model *model, const dea_axis *axis, dea_quantities *quantities,
                        dea_network *network, dea_error *error)
{
    *network = (dea_network){0};
    if (!model->network) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the model %s is not a network", model->name);
    }
    (void)dea_expr_number(&network->pool, 0.0);
    if (network->pool.exhausted) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a network is built");
    }
    dea_symbols symbols = dea_symbols_of(scene, axis, &network->pool);
    if (quantities && !network->pool.exhausted) {
        *quantities = (dea_quantities){0};
        const dea_expr modulus = scalar(&network->pool, scene, axis, &scene->material.modulus);
        lift_all(quantities, &symbols, "", given(&network->pool, modulus));
    }
    dea_symbols second;
    if (scene->antagonist.there && !network->pool.exhausted) {
        second = second_symbols(scene, axis, &symbols, quantities);
        symbols.second = &second;
        symbols.loaded = true;
    }
    return dea_network_build_symbols(&symbols, model, network, error);
}

dea_status dea_network_build_named(const dea_scene *scene, const dea_model *model, const dea_axis *axis,
                                   dea_quantities *quantities, dea_network *network, dea_error *error)
{
    return build(scene, model, axis, quantities, network, error);
}

dea_status dea_network_build(const dea_scene *scene, const dea_model *model, const dea_axis *axis, dea_network *network,
                             dea_error *error)
{
    return build(scene, model, axis, NULL, network, error);
}

static dea_expr sum_of(dea_network *network, dea_role role)
{
    dea_pool *pool = &network->pool;
    dea_expr sum = NUM(0.0);
    for (int i = 0; i < network->element_count; i++) {
        if (network->elements[i].role == role) {
            sum = ADD(sum, network->elements[i].value);
        }
    }
    return sum;
}

int dea_network_stresses(dea_network *network, dea_network_stress *stresses)
{
    dea_pool *pool = &network->pool;
    int count = 0, own = 0; /* levers of two films may be equal as numbers and are not as formulas: they are counted apart */
    for (int i = 0; i < network->element_count; i++) {
        const dea_element *element = &network->elements[i];
        int k = element->second ? own : 0;
        while (k < count && stresses[k].lever != element->lever) {
            k++;
        }
        if (element->role == DEA_ROLE_HYPERELASTIC && k < count) {
            stresses[k].stress = ADD(stresses[k].stress, element->value);
        } else if (element->role == DEA_ROLE_HYPERELASTIC && count < DEA_NETWORK_STRESSES) {
            stresses[count++] = (dea_network_stress){element->value, element->lever};
        } else if (element->role == DEA_ROLE_HYPERELASTIC) {
            pool->exhausted = true; /* a network that holds more is not built */
        }
        own = element->second ? own : count;
    }
    if (count == 0) {
        stresses[count++] = (dea_network_stress){MUL(sum_of(network, DEA_ROLE_SPRING), network->edge), NUM(1.0)};
    }
    return count;
}

dea_expr dea_network_tension(dea_network *network)
{
    dea_pool *pool = &network->pool;
    const dea_expr elastic = ADD(sum_of(network, DEA_ROLE_TENSION), MUL(sum_of(network, DEA_ROLE_BESIDE), network->edge));
    return SUB(elastic, dea_network_steady(network));
}

dea_expr dea_network_steady(dea_network *network)
{
    return sum_of(network, DEA_ROLE_STEADY);
}

dea_expr dea_network_softening(dea_network *network)
{
    return sum_of(network, DEA_ROLE_SOFTENING);
}

dea_expr dea_network_elastic(dea_network *network)
{
    dea_pool *pool = &network->pool;
    const dea_expr stiffness = ADD(sum_of(network, DEA_ROLE_SPRING), sum_of(network, DEA_ROLE_SOFTENING));
    dea_expr force = dea_network_tension(network);
    for (int i = 0; i < network->element_count; i++) {
        if (network->elements[i].role == DEA_ROLE_HYPERELASTIC) {
            force = ADD(force, MUL(network->elements[i].lever, network->elements[i].value));
        }
    }
    return ADD(MUL(stiffness, network->edge), force);
}

dea_expr dea_network_load(dea_network *network)
{
    return sum_of(network, DEA_ROLE_SOURCE);
}
