/* From the scene to one static point. */
#include <stddef.h>

#include "film/edge.h"
#include "film/point.h"
#include "film/second.h"

void dea_film_prepare(const dea_scene *scene, dea_film *film)
{
    const dea_material *material = &scene->material;
    const double stretch = scene->actuator.prestretch;
    double constants[DEA_LAW_CONSTANTS];

    dea_material_long_term(material, constants);
    *film = dea_law_film(material->law, constants, stretch);
    const double layers = scene->actuator.layers;
    const double relative = dea_material_permittivity(material, stretch);
    film->permittivity = DEA_EPSILON_0 * relative * (layers * layers);
    film->electrostriction = material->permittivity_follows ? material->permittivity_per_stretch / relative : 0.0;
    film->breakdown = isnan(material->breakdown) ? INFINITY : material->breakdown;
    film->modulus = isnan(material->modulus) ? film->slope : material->modulus * dea_material_long_term_share(material);
}

static double coverage_of(const dea_actuator *actuator)
{
    return isnan(actuator->divide_radius) ? actuator->coverage : actuator->divide_radius / actuator->frame_radius;
}

/* x (1 - 3 B^2)/4 - B^4 ln B with x = 1 - B^2 is sum of x^k/(k (k - 1) (k - 2)) from k = 3 on: of a narrow annulus the terms cancel. */
static double sheet_of_annulus(double b)
{
    const double b2 = b * b, x = (1.0 - b) * (1.0 + b);
    if (x > 0.2) {
        return (0.25 * x * (1.0 - 3.0 * b2) - b2 * b2 * log(b)) / (2.0 * DEA_PI * x * x);
    }
    double sum = 0.0, power = x;
    for (int k = 3; k < 30; k++, power *= x) {
        sum += power / (k * (k - 1) * (k - 2));
    }
    return sum / (2.0 * DEA_PI);
}

double dea_sheet_share(dea_kind kind, double coverage, double layers)
{
    const double one = kind == DEA_DOT ? 0.125 / DEA_PI : sheet_of_annulus(coverage);
    return one * (4.0 * layers - 2.0) / (layers * layers);
}

double dea_series_resistance(const dea_scene *scene)
{
    const dea_actuator *actuator = &scene->actuator;
    const double sheet = scene->electrode.sheet_resistance, drive = scene->drive.series_resistance;
    if (!(sheet > 0.0)) {
        return drive;
    }
    const double own = sheet * dea_sheet_share(actuator->kind, coverage_of(actuator), actuator->layers);
    return isnan(drive) ? own : drive + own;
}

/* Share of the source voltage that a leaking film sees at rest: R_p/(R_s + R_p). */
static double film_share(const dea_scene *scene)
{
    const double leakage = scene->drive.leakage_resistance, series = isnan(leakage) ? leakage : dea_series_resistance(scene);
    return isnan(series) ? 1.0 : leakage / (series + leakage);
}

static void place_skin(const dea_electrode *electrode, dea_point *point)
{
    point->skin_share = electrode->law ? electrode->thickness / point->film_thickness : 0.0;
    if (electrode->law) {
        point->skin = dea_law_film(electrode->law, electrode->constants, 1.0);
    }
}

static void place_second(const dea_scene *scene, dea_second *second)
{
    dea_scene other;
    second->there = scene->antagonist.there;
    if (!second->there) {
        return;
    }
    dea_second_scene(scene, &other);
    dea_film_prepare(&other, &second->film);
    second->kind = other.actuator.kind;
    second->film_thickness = other.actuator.layers * other.actuator.film_thickness;
    second->layers = other.actuator.layers;
    second->voltage = other.drive.voltage;
}

static void place_loads(const dea_scene *scene, dea_point *point)
{
    const dea_edge_terms edge = dea_scene_edge(scene);
    point->load = edge.stiffness;
    point->force = edge.force;
    point->spring_count = 0;
    for (size_t i = 0; i < DEA_LOADS && edge.bent; i++) {
        if (dea_load_is_given(&scene->loads[i]) && scene->loads[i].kind->spring) {
            point->springs[point->spring_count++] = scene->loads[i];
        }
    }
}

void dea_point_shape(const dea_scene *scene, dea_point *point)
{
    const dea_actuator *actuator = &scene->actuator;
    point->kind = actuator->kind;
    point->frame_radius = actuator->frame_radius;
    point->coverage = coverage_of(actuator);
    point->film_thickness = actuator->layers * actuator->film_thickness;
    point->layers = actuator->layers;
    point->voltage = scene->drive.voltage * film_share(scene);
    point->focal_length = actuator->focal_length;
    point->refractive_index = actuator->refractive_index;
}

void dea_point_place(const dea_scene *scene, dea_point *point)
{
    dea_point_shape(scene, point);
    place_loads(scene, point);
    place_second(scene, &point->second);
    place_skin(&scene->electrode, point);
}

bool dea_point_valid(const dea_point *point)
{
    const dea_film *film = &point->film;
    if (point->second.there) {
        const dea_point second = dea_point_second(point);
        dea_point alone = *point;
        alone.second.there = false;
        return dea_point_valid(&alone) && dea_point_valid(&second);
    }
    return point->frame_radius > 0.0 && point->coverage > 0.0 && point->coverage < 1.0 && point->film_thickness > 0.0 &&
           film->prestretch >= 1.0 && film->permittivity > 0.0 && dea_point_electric(point).first > 0.0 && film->valid && isfinite(film->modulus) &&
           isfinite(point->voltage) && isfinite(point->force) && (point->skin_share == 0.0 || (point->skin_share > 0.0 && point->skin.valid));
}

/* int w^2 dA over the disc of radius a [m^2]: w = R/a. */
static double moving_disc(double a)
{
    return 0.5 * DEA_PI * a * a;
}

/* int w^2 dA over the annulus from a to f = a/b [m^2], w = (f^2/R - R)/(f^2/a - a): 2 pi a^2 q/x^2 with x = 1 - b^2 and
 * q = -ln b - x + (1 - b^4)/4 = sum of x^k/(2 k) from k = 3 on, which keeps the digits of a narrow annulus. */
static double moving_annulus(double a, double b)
{
    const double x = (1.0 - b) * (1.0 + b);
    double q = (-log(b) - x + 0.25 * (1.0 - b * b * b * b)) / (x * x);
    if (x < 0.2) {
        double power = x;
        q = 0.0;
        for (int k = 3; k < 30; k++) {
            q += power / (2.0 * k);
            power *= x;
        }
    }
    return 2.0 * DEA_PI * a * a * q;
}

double dea_electrode_mass(const dea_scene *scene)
{
    if (scene->electrode.law && !isnan(scene->electrode.density)) {
        return scene->electrode.density * scene->electrode.thickness;
    }
    return isnan(scene->actuator.electrode_mass) ? 0.0 : scene->actuator.electrode_mass;
}

double dea_point_mass(const dea_scene *scene, const dea_point *point)
{
    if (isnan(scene->material.density)) {
        return 0.0;
    }
    const double b = point->coverage;
    const double radius = b * point->frame_radius;
    const double reference = radius / point->film.prestretch; /* A = r_a/lambda_pre in the film of thickness H */
    const double film = moving_disc(reference) + moving_annulus(reference, b);
    const double electrode = point->kind == DEA_DOT ? moving_disc(radius) : moving_annulus(radius, b);
    const double areal = dea_electrode_mass(scene);
    double load = dea_scene_edge(scene).mass;
    if (point->second.there) {
        const dea_point second = dea_point_second(point);
        dea_scene other;
        dea_second_scene(scene, &other);
        load += dea_point_mass(&other, &second);
    }
    return scene->material.density * point->film_thickness * film + areal * electrode + load;
}

/* The membrane at rest, W11 (w'' + w'/R - w/R^2) + m omega^2 w = 0 in the reference film of thickness H with m its mass per volume,
 * that of the electrodes spread over it: w = J1(k R) on the disc, J1(k R) Y1(k F) - Y1(k R) J1(k F) on the annulus, k = omega
 * sqrt(m/W11). w and w' are continuous at A; this is what is left of that. */
static double mode_gap(double omega, const double pace[2], double a, double f)
{
    const double in = omega * pace[0], out = omega * pace[1], x = in * a, y = out * a, rim = out * f;
    const double disc = j1(x), disc_slope = in * (j0(x) - disc / x);
    const double annulus = j1(y) * y1(rim) - y1(y) * j1(rim);
    const double annulus_slope = out * ((j0(y) - j1(y) / y) * y1(rim) - (y0(y) - y1(y) / y) * j1(rim));
    return disc_slope * annulus - disc * annulus_slope;
}

/* The first zero lies between those of films that are all as heavy as the heavier and the lighter region: k F = 3.8317. */
double dea_point_resonance(const dea_scene *scene, const dea_point *point)
{
    static const double bessel_root = 3.8317059702075123156; /* of J1 */
    enum { SCAN = 64 };
    const double l0 = point->film.prestretch, f = point->frame_radius / l0, a = point->coverage * f;
    const double areal = dea_electrode_mass(scene);
    if (point->skin_share > 0.0 || dea_point_is_loaded(point) || dea_scene_edge(scene).mass > 0.0) {
        return (double)NAN; /* the two regions have one modulus no more, or the edge a mass of its own */
    }
    const double bare = scene->material.density, coated = bare + areal * l0 * l0 / point->film_thickness;
    const double disc = point->kind == DEA_DOT ? coated : bare, annulus = point->kind == DEA_DOT ? bare : coated;
    const double pace[2] = {sqrt(disc / point->film.w11), sqrt(annulus / point->film.w11)};
    double low = bessel_root / (f * fmax(pace[0], pace[1])), high = bessel_root / (f * fmin(pace[0], pace[1]));
    const double ratio = pow(high / low, 1.0 / SCAN), sign = mode_gap(0.5 * low, pace, a, f);
    double next = low;
    for (int i = 0; i < SCAN && high > low && mode_gap(next, pace, a, f) * sign > 0.0; i++) {
        low = next;
        next *= ratio;
    }
    high = next;
    while (high - low > 1e-13 * high) {
        const double middle = 0.5 * (low + high);
        *(mode_gap(middle, pace, a, f) * sign > 0.0 ? &low : &high) = middle;
    }
    return 0.5 * (low + high) / (2.0 * DEA_PI);
}

/* h = 2 a sinh(asinh(3 V/(pi a^3))/3), f = (a^2 + h^2)/(2 h (n - 1)). */
double dea_lens_focal_length(double rest, double refractive_index, double radius, double strain)
{
    const double curvature = rest * (refractive_index - 1.0); /* its radius at rest */
    const double h0 = radius * radius / (curvature + sqrt((curvature - radius) * (curvature + radius)));
    const double volume = 0.5 * h0 * (3.0 * radius * radius + h0 * h0); /* 3 V/pi */
    const double a = radius * (1.0 + strain);
    const double h = 2.0 * a * sinh(asinh(volume / (a * a * a)) / 3.0);
    return curvature > 0.0 ? (a * a + h * h) / (2.0 * h * (refractive_index - 1.0)) : (double)NAN;
}
