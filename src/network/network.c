#include "network/network.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

void dea_network_free(dea_network *network)
{
    if (network) {
        dea_pool_free(&network->pool);
    }
}

void dea_network_add(dea_network *network, dea_role role, const char *name, const char *meaning, dea_ref value)
{
    network->elements[network->element_count++] = (dea_element){role, name, meaning, value};
}

void dea_network_taut(dea_network *network, dea_ref tension)
{
    network->tension[network->tension_count++] = tension;
}

void dea_network_limit_area(const dea_symbols *symbols, dea_network *network)
{
    dea_pool *pool = symbols->pool;
    const dea_ref one = dea_number(pool, 1.0);
    const dea_ref stretch = dea_add(pool, one, network->strain);
    dea_ref area = dea_square(pool, stretch);
    if (symbols->kind == DEA_LENS) {
        const dea_ref edge = dea_square(pool, dea_mul(pool, symbols->coverage, stretch));
        area = dea_div(pool, dea_sub(pool, one, edge), dea_sub(pool, one, dea_square(pool, symbols->coverage)));
    }
    const dea_ref rest = dea_mul(pool, dea_div(pool, symbols->voltage, symbols->film_thickness), dea_square(pool, symbols->prestretch));
    network->field = dea_mul(pool, rest, area);
}

/* A scalar of the scene: symbol 0 where it is the axis, else its number. */
static dea_ref scalar(dea_pool *pool, const dea_scene *scene, const dea_axis *axis, const double *field)
{
    const size_t offset = (size_t)((const char *)field - (const char *)scene);
    return axis && axis->offset == offset ? dea_symbol(pool, 0) : dea_number(pool, *field);
}

static bool given(const dea_pool *pool, dea_ref ref)
{
    return pool->terms[ref].varies || !isnan(dea_constant(pool, ref));
}

/* Long-term share of the elastic constants, 1 - sum g_i where they are instantaneous. */
static dea_ref long_term_share(dea_pool *pool, const dea_scene *scene, const dea_axis *axis)
{
    dea_ref share = dea_number(pool, 1.0);
    if (scene->material.instantaneous) {
        for (size_t i = 0; i < scene->material.prony_count; i++) {
            share = dea_sub(pool, share, scalar(pool, scene, axis, &scene->material.prony[i].g));
        }
    }
    return share;
}

/* Source voltage, less what a leaking film leaves on the series resistance. */
static dea_ref film_voltage(dea_pool *pool, const dea_scene *scene, const dea_axis *axis)
{
    const dea_ref source = scalar(pool, scene, axis, &scene->drive.voltage);
    const dea_ref series = scalar(pool, scene, axis, &scene->drive.series_resistance);
    const dea_ref leakage = scalar(pool, scene, axis, &scene->drive.leakage_resistance);
    if (!given(pool, series) || !given(pool, leakage)) {
        return source;
    }
    return dea_mul(pool, source, dea_div(pool, leakage, dea_add(pool, series, leakage)));
}

dea_yeoh_terms dea_symbols_yeoh(const dea_symbols *symbols)
{
    dea_pool *pool = symbols->pool;
    const dea_ref one = dea_number(pool, 1.0);
    const dea_ref l = symbols->prestretch;
    const dea_ref y = dea_square(pool, l);
    const dea_ref y2 = dea_square(pool, y);
    const dea_ref p = dea_mul(pool, dea_sub(pool, l, one), dea_add(pool, l, one)); /* y - 1 */
    dea_yeoh_terms t;
    t.square = y;
    t.g = dea_div(pool, dea_mul(pool, p, dea_add(pool, y2, dea_add(pool, y, one))), y2);
    t.j = dea_div(pool, dea_mul(pool, dea_square(pool, p), dea_add(pool, dea_scale(pool, 2.0, y), one)), y2);
    t.w = dea_add(pool, symbols->yeoh[0],
                  dea_mul(pool, t.j, dea_add(pool, dea_scale(pool, 2.0, symbols->yeoh[1]), dea_mul(pool, dea_scale(pool, 3.0, symbols->yeoh[2]), t.j))));
    return t;
}

/* Y = dsigma/dlambda = 4 (lambda + 2 lambda^-5) w + 8 g^2 (2 C2 + 6 C3 J)/lambda. */
static dea_ref operating_modulus(const dea_symbols *symbols)
{
    dea_pool *pool = symbols->pool;
    const dea_yeoh_terms t = dea_symbols_yeoh(symbols);
    const dea_ref l = symbols->prestretch;
    const dea_ref fifth = dea_mul(pool, dea_square(pool, t.square), l);
    const dea_ref dg = dea_add(pool, l, dea_div(pool, dea_number(pool, 2.0), fifth));
    const dea_ref wj = dea_add(pool, dea_scale(pool, 2.0, symbols->yeoh[1]), dea_mul(pool, dea_scale(pool, 6.0, symbols->yeoh[2]), t.j));
    return dea_add(pool, dea_scale(pool, 4.0, dea_mul(pool, dg, t.w)),
                   dea_scale(pool, 8.0, dea_div(pool, dea_mul(pool, dea_square(pool, t.g), wj), l)));
}

static dea_symbols symbols_of(const dea_scene *scene, const dea_axis *axis, dea_pool *pool)
{
    const dea_actuator *actuator = &scene->actuator;
    const dea_material *material = &scene->material;
    const dea_ref share = long_term_share(pool, scene, axis);
    dea_symbols s = {.pool = pool, .kind = actuator->kind};
    s.frame_radius = scalar(pool, scene, axis, &actuator->frame_radius);
    const dea_ref divide = scalar(pool, scene, axis, &actuator->divide_radius);
    s.coverage = given(pool, divide) ? dea_div(pool, divide, s.frame_radius) : scalar(pool, scene, axis, &actuator->coverage);
    s.film_thickness = scalar(pool, scene, axis, &actuator->film_thickness);
    s.prestretch = scalar(pool, scene, axis, &actuator->prestretch);
    for (int i = 0; i < DEA_YEOH_TERMS; i++) {
        s.yeoh[i] = dea_mul(pool, share, scalar(pool, scene, axis, &material->yeoh[i]));
    }
    const dea_ref modulus = scalar(pool, scene, axis, &material->modulus);
    s.modulus = given(pool, modulus) ? dea_mul(pool, share, modulus) : operating_modulus(&s);
    const dea_ref slope = scalar(pool, scene, axis, &material->permittivity_per_stretch);
    const dea_ref relative = dea_add(pool, scalar(pool, scene, axis, &material->permittivity), dea_mul(pool, slope, s.prestretch));
    s.permittivity = dea_scale(pool, DEA_EPSILON_0, relative);
    const dea_ref breakdown = scalar(pool, scene, axis, &material->breakdown);
    s.breakdown = given(pool, breakdown) ? breakdown : dea_number(pool, INFINITY);
    s.voltage = film_voltage(pool, scene, axis);
    return s;
}

dea_ref dea_symbols_pressure(const dea_symbols *symbols)
{
    dea_pool *pool = symbols->pool;
    return dea_mul(pool, symbols->permittivity, dea_square(pool, dea_div(pool, symbols->voltage, symbols->film_thickness)));
}

static dea_ref divide_radius(const dea_symbols *symbols)
{
    return dea_mul(symbols->pool, symbols->frame_radius, symbols->coverage);
}

dea_ref dea_symbols_cross_section(const dea_symbols *symbols)
{
    dea_pool *pool = symbols->pool;
    const dea_ref circumference = dea_scale(pool, 2.0 * pi, divide_radius(symbols));
    return dea_mul(pool, circumference, dea_div(pool, symbols->film_thickness, dea_square(pool, symbols->prestretch)));
}

dea_ref dea_symbols_disc_strain(const dea_symbols *symbols)
{
    return dea_div(symbols->pool, dea_node(symbols->pool, 0), divide_radius(symbols));
}

dea_ref dea_symbols_annulus_width(const dea_symbols *symbols)
{
    dea_pool *pool = symbols->pool;
    return dea_mul(pool, symbols->frame_radius, dea_sub(pool, dea_number(pool, 1.0), symbols->coverage));
}

dea_ref dea_symbols_annulus_strain(const dea_symbols *symbols)
{
    return dea_neg(symbols->pool, dea_div(symbols->pool, dea_node(symbols->pool, 0), dea_symbols_annulus_width(symbols)));
}

/* What every network has, whatever its elements: coordinates, limits, ranges. */
static void place_edge(const dea_symbols *symbols, dea_network *network)
{
    dea_pool *pool = symbols->pool;
    const dea_ref one = dea_number(pool, 1.0);
    network->edge = dea_node(pool, 0);
    network->strain = dea_symbols_disc_strain(symbols);
    network->sign = symbols->kind == DEA_DOT ? 1.0 : -1.0;
    network->length = dea_mul(pool, divide_radius(symbols), dea_sub(pool, one, symbols->coverage)); /* below both r_a and r - r_a */
    network->end = dea_number(pool, 0.0);
    network->range[0] = symbols->coverage;
    network->range[1] = dea_sub(pool, one, symbols->coverage);
    network->range[2] = symbols->permittivity;
    network->range[3] = symbols->yeoh[0];
    network->breakdown = symbols->breakdown;
}

dea_status dea_network_build(const dea_scene *scene, const dea_model *model, const dea_axis *axis, dea_network *network, dea_error *error)
{
    *network = (dea_network){0};
    if (!model->network) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the model %s is not a network", model->name);
    }
    (void)dea_number(&network->pool, 0.0);
    if (network->pool.exhausted) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a network is built");
    }
    const dea_symbols symbols = symbols_of(scene, axis, &network->pool);
    place_edge(&symbols, network);
    model->network(&symbols, network);
    if (network->pool.exhausted) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a network is built");
    }
    return DEA_OK;
}

dea_ref dea_network_elastic(dea_network *network)
{
    dea_pool *pool = &network->pool;
    dea_ref stiffness = dea_number(pool, 0.0);
    dea_ref force = stiffness;
    for (int i = 0; i < network->element_count; i++) {
        const dea_element *element = &network->elements[i];
        if (element->role == DEA_ROLE_SPRING) {
            stiffness = dea_add(pool, stiffness, element->value);
        } else if (element->role == DEA_ROLE_HYPERELASTIC) {
            force = dea_add(pool, force, element->value);
        }
    }
    return dea_add(pool, dea_mul(pool, stiffness, network->edge), force);
}

dea_ref dea_network_load(dea_network *network)
{
    dea_pool *pool = &network->pool;
    dea_ref load = dea_number(pool, 0.0);
    for (int i = 0; i < network->element_count; i++) {
        if (network->elements[i].role == DEA_ROLE_SOURCE) {
            load = dea_add(pool, load, network->elements[i].value);
        }
    }
    return load;
}
