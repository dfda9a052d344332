#include "network/rings.h"

#include <math.h>

/* Gauss-Lobatto rule of degree p on [-1, 1]: its p + 1 nodes, weights, and derivatives of the Lagrange polynomials at the nodes. */
typedef struct lobatto {
    size_t degree;
    double places[DEA_RINGS_DEGREE + 1], weights[DEA_RINGS_DEGREE + 1];
    double slopes[DEA_RINGS_DEGREE + 1][DEA_RINGS_DEGREE + 1]; /* of polynomial n at place q: [q][n] */
} lobatto;

/* Legendre polynomial of degree n and, in *before, of degree n - 1. */
static double legendre(size_t n, double x, double *before)
{
    double last = 1.0, now = x;
    for (size_t k = 2; k <= n; k++) {
        const double next = ((2.0 * (double)k - 1.0) * x * now - ((double)k - 1.0) * last) / (double)k;
        last = now;
        now = next;
    }
    *before = last;
    return now;
}

/* The inner nodes are the zeros of P_n': Newton on (1 - x^2) P_n' = n (P_{n-1} - x P_n), whose slope is -n (n + 1) P_n. */
static double lobatto_place(size_t n, size_t i)
{
    double x = -cos(DEA_PI * (double)i / (double)n), before = 0.0;
    for (int k = 0; k < 50; k++) {
        const double value = legendre(n, x, &before);
        const double step = (before - x * value) / ((double)(n + 1) * value);
        x += step;
        if (fabs(step) < 1e-16) {
            break;
        }
    }
    return x;
}

static void make_lobatto(size_t n, lobatto *rule)
{
    double values[DEA_RINGS_DEGREE + 1], before;
    const double ends = (double)n * (double)(n + 1);
    rule->degree = n;
    for (size_t i = 0; i <= n; i++) {
        rule->places[i] = i == 0 ? -1.0 : i == n ? 1.0 : 2 * i == n ? 0.0 : lobatto_place(n, i);
        values[i] = legendre(n, rule->places[i], &before);
        rule->weights[i] = 2.0 / (ends * values[i] * values[i]);
    }
    for (size_t q = 0; q <= n; q++) {
        double others = 0.0;
        for (size_t i = 0; i <= n; i++) {
            rule->slopes[q][i] = q == i ? 0.0 : values[q] / (values[i] * (rule->places[q] - rule->places[i]));
            others += rule->slopes[q][i];
        }
        rule->slopes[q][q] = -others; /* the slopes of a constant sum to 0 */
    }
}

/* One element of the film between two reference radii. */
typedef struct element {
    double from, to; /* [m] */
    bool logarithmic, disc, electroded;
    size_t node; /* number of its first node, the one at the centre being 0 and not moving */
} element;

/* Reference radius at place x of [-1, 1], and dR/dx. */
static double radius_at(const element *e, double x, double *stretch)
{
    if (e->logarithmic) {
        const double r = x == 1.0 ? e->to : e->from * exp(0.5 * (1.0 + x) * log(e->to / e->from));
        *stretch = 0.5 * r * log(e->to / e->from);
        return r;
    }
    *stretch = 0.5 * (e->to - e->from);
    return x == 1.0 ? e->to : e->from + (1.0 + x) * *stretch;
}

/* The ring at place q of an element: V_qn = 1 at its own node, D_qn from the polynomials' slopes. Nodes at the centre (number 0) and
 * at the frame (number @p frame) do not move. */
static void place_ring(const element *e, const lobatto *rule, size_t q, size_t frame, const dea_point *point, dea_rings *rings)
{
    double stretch;
    const double radius = radius_at(e, rule->places[q], &stretch), l0 = point->film.prestretch;
    if (radius == 0.0) {
        return; /* at the centre a ring has no volume */
    }
    const size_t from = e->node == 0 ? 1 : 0, to = e->node + rule->degree == frame ? rule->degree - 1 : rule->degree;
    const double area = 2.0 * DEA_PI * radius * stretch * rule->weights[q];
    dea_ring *ring = &rings->rings[rings->ring_count++];
    *ring = (dea_ring){.radius = radius, .volume = area * point->film_thickness, .disc = e->disc, .electroded = e->electroded};
    ring->first = e->node + from - 1;
    ring->count = to + 1 - from;
    for (size_t i = from; i <= to; i++) {
        ring->radial[i - from] = rule->slopes[q][i] / (stretch * l0);
        ring->hoop[i - from] = i == q ? 1.0 / (radius * l0) : 0.0;
    }
    const size_t node = e->node + q;
    if (node != frame) {
        rings->radii[node - 1] = radius;
        rings->areas[node - 1] += area;
        rings->coated[node - 1] += e->electroded ? area : 0.0;
    }
}

static void cut_element(const element *e, size_t degree, size_t frame, const dea_point *point, dea_rings *rings)
{
    lobatto rule;
    make_lobatto(degree, &rule);
    for (size_t q = 0; q <= degree; q++) {
        place_ring(e, &rule, q, frame, point, rings);
    }
}

void dea_rings_cut(const dea_point *point, dea_rings_mesh mesh, dea_rings *rings)
{
    const double rim = point->frame_radius / point->film.prestretch, edge = point->coverage * rim;
    const bool dot = point->kind == DEA_DOT;
    const element disc = {.to = edge, .disc = true, .electroded = dot};
    const element annulus = {.from = edge, .to = rim, .logarithmic = mesh.logarithmic, .electroded = !dot, .node = mesh.disc};
    const size_t frame = mesh.disc + mesh.annulus;
    *rings = (dea_rings){.mesh = mesh, .node_count = frame - 1, .edge = mesh.disc - 1, .rim = rim};
    cut_element(&disc, mesh.disc, frame, point, rings);
    cut_element(&annulus, mesh.annulus, frame, point, rings);
}

/* The edge is the last node of the disc's rings, and the first of the annulus's. */
void dea_rings_tie(dea_rings *rings, size_t first)
{
    for (size_t r = 0; r < rings->ring_count; r++) {
        dea_ring *ring = &rings->rings[r];
        const size_t edge = ring->disc ? ring->count - 1 : 0;
        ring->tie[0] = ring->radial[edge];
        ring->tie[1] = ring->hoop[edge];
        ring->radial[edge] = ring->hoop[edge] = 0.0;
        for (size_t i = edge; i + 1 < ring->count; i++) {
            ring->radial[i] = ring->radial[i + 1];
            ring->hoop[i] = ring->hoop[i + 1];
        }
        ring->first += first;
        ring->count--;
    }
}

void dea_rings_slopes_of(size_t degree, dea_rings_slopes *slopes)
{
    lobatto rule;
    make_lobatto(degree, &rule);
    for (size_t q = 0; q <= degree; q++) {
        slopes->places[q] = rule.places[q];
        slopes->weights[q] = rule.weights[q];
        for (size_t n = 0; n <= degree; n++) {
            slopes->of[q][n] = rule.slopes[q][n];
        }
    }
}

static element element_of(const dea_rings *rings, bool disc)
{
    const double edge = rings->radii[rings->edge];
    return disc ? (element){.to = edge} : (element){.from = edge, .to = rings->rim, .logarithmic = rings->mesh.logarithmic};
}

/* The centre has no ring: what is smooth there has the slope 0, which tells its value from the others. */
void dea_rings_derivative(const dea_rings *rings, bool disc, double (*gradient)[DEA_RINGS_DEGREE + 1])
{
    const element e = element_of(rings, disc);
    const size_t degree = disc ? rings->mesh.disc : rings->mesh.annulus, first = disc ? 1 : 0;
    lobatto rule;
    make_lobatto(degree, &rule);
    for (size_t q = first; q <= degree; q++) {
        double stretch;
        radius_at(&e, rule.places[q], &stretch);
        for (size_t n = first; n <= degree; n++) {
            const double centre = disc ? rule.slopes[q][0] * rule.slopes[0][n] / rule.slopes[0][0] : 0.0;
            gradient[q - first][n - first] = (rule.slopes[q][n] - centre) / stretch;
        }
    }
}

/* Values at places of an element, along R or ln R, and the weights of their polynomial in the barycentric form. */
typedef struct samples {
    size_t count;
    double places[DEA_RINGS_DEGREE + 1], values[DEA_RINGS_DEGREE + 1], weights[DEA_RINGS_DEGREE + 1];
} samples;

static samples samples_of(const dea_rings *rings, bool disc, const double *values)
{
    samples s = {0};
    for (size_t q = 0; q < rings->ring_count; q++) {
        const dea_ring *ring = &rings->rings[q];
        if (ring->disc == disc) {
            s.places[s.count] = disc || !rings->mesh.logarithmic ? ring->radius : log(ring->radius);
            s.values[s.count++] = values[q];
        }
    }
    const double width = 0.25 * (s.places[s.count - 1] - s.places[0]); /* keeps the products near 1 */
    for (size_t i = 0; i < s.count; i++) {
        double product = 1.0;
        for (size_t k = 0; k < s.count; k++) {
            product *= k == i ? 1.0 : (s.places[i] - s.places[k]) / width;
        }
        s.weights[i] = 1.0 / product;
    }
    return s;
}

static double polynomial(const samples *s, double x)
{
    double over = 0.0, under = 0.0;
    for (size_t i = 0; i < s->count; i++) {
        if (x == s->places[i]) {
            return s->values[i];
        }
        const double share = s->weights[i] / (x - s->places[i]);
        over += share * s->values[i];
        under += share;
    }
    return over / under;
}

/* Largest value of the polynomial between two places, by golden sections, and where. */
static double largest_between(const samples *s, double low, double high, double *place)
{
    static const double golden = 0.6180339887498949;
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double at_a = polynomial(s, a), at_b = polynomial(s, b);
    for (int i = 0; i < 40; i++) { /* an extreme is flat: half of the digits of its place are enough */
        const bool left = at_a > at_b;
        *(left ? &high : &low) = left ? b : a;
        *(left ? &b : &a) = left ? a : b;
        *(left ? &at_b : &at_a) = left ? at_a : at_b;
        const double fresh = left ? high - golden * (high - low) : low + golden * (high - low);
        *(left ? &a : &b) = fresh;
        *(left ? &at_a : &at_b) = polynomial(s, fresh);
    }
    *place = at_a > at_b ? a : b;
    return fmax(at_a, at_b);
}

double dea_rings_largest(const dea_rings *rings, bool disc, const double *values, double *radius)
{
    const samples s = samples_of(rings, disc, values);
    const size_t parts = 4 * s.count;
    const double first = disc ? 0.0 : s.places[0], last = s.places[s.count - 1];
    double largest = polynomial(&s, first);
    double place = first, between = first;
    for (size_t i = 1; i <= parts; i++) {
        const double x = i == parts ? last : first + (last - first) * (double)i / (double)parts, value = polynomial(&s, x);
        place = value > largest ? x : place;
        largest = fmax(largest, value);
    }
    const double width = (last - first) / (double)parts;
    const double peak = s.count < 3 ? largest : largest_between(&s, fmax(first, place - width), fmin(last, place + width), &between);
    place = peak > largest + 1e-12 * fabs(largest) ? between : place; /* at an end of the element it is that end */
    if (radius) {
        *radius = disc || !rings->mesh.logarithmic ? place : exp(place);
    }
    return fmax(largest, peak);
}

/* Lagrange polynomial number @p n of a degree at x. */
static double lagrange(const double *places, size_t degree, size_t n, double x)
{
    double value = 1.0;
    for (size_t i = 0; i <= degree; i++) {
        value *= i == n ? 1.0 : (x - places[i]) / (places[n] - places[i]);
    }
    return value;
}

/* One element; its nodes begin with number @p from of one mesh and @p to of the other, 0 being the centre, and do not move at
 * both ends of the film. */
static void transfer_element(size_t degree, size_t from, size_t from_count, size_t finer, size_t to, size_t to_count, double *matrix)
{
    lobatto rule, other;
    make_lobatto(degree, &rule);
    make_lobatto(finer, &other);
    for (size_t q = 0; q <= finer; q++) {
        for (size_t n = 0; n <= degree; n++) {
            const size_t row = to + q, column = from + n;
            if (row > 0 && row <= to_count && column > 0 && column <= from_count) {
                matrix[(row - 1) * from_count + column - 1] = lagrange(rule.places, degree, n, other.places[q]);
            }
        }
    }
}

void dea_rings_transfer(dea_rings_mesh from, dea_rings_mesh to, double *matrix)
{
    const size_t from_count = from.disc + from.annulus - 1, to_count = to.disc + to.annulus - 1;
    for (size_t i = 0; i < from_count * to_count; i++) {
        matrix[i] = 0.0;
    }
    transfer_element(from.disc, 0, from_count, to.disc, 0, to_count, matrix);
    transfer_element(from.annulus, from.disc, from_count, to.annulus, to.disc, to_count, matrix);
}

void dea_rings_move(const double *matrix, size_t from_count, const double *u, size_t to_count, double *v)
{
    for (size_t i = 0; i < to_count; i++) {
        v[i] = 0.0;
        for (size_t n = 0; n < from_count; n++) {
            v[i] += matrix[i * from_count + n] * u[n];
        }
    }
}

dea_rings_spot dea_rings_spot_at(const dea_rings *rings, double radius, bool outside)
{
    const double edge = rings->radii[rings->edge];
    dea_rings_spot spot = {.radius = radius, .disc = radius < edge || (radius <= edge && !outside)};
    const element e = element_of(rings, spot.disc);
    const double x = e.logarithmic ? 2.0 * log(radius / e.from) / log(e.to / e.from) - 1.0 : 2.0 * (radius - e.from) / (e.to - e.from) - 1.0;
    double stretch, weights[DEA_RINGS_DEGREE + 1];
    lobatto rule;
    spot.degree = spot.disc ? rings->mesh.disc : rings->mesh.annulus;
    make_lobatto(spot.degree, &rule);
    radius_at(&e, fmin(x, 1.0), &stretch);
    for (size_t n = 0; n <= spot.degree; n++) {
        weights[n] = lagrange(rule.places, spot.degree, n, fmin(x, 1.0));
    }
    for (size_t q = 0; q <= spot.degree; q++) {
        spot.value[q] = weights[q];
        for (size_t n = 0; n <= spot.degree; n++) { /* slopes of polynomials of that degree are exact at the nodes */
            spot.slope[q] += weights[n] * rule.slopes[n][q] / stretch;
        }
        spot.even[q] = weights[q] - (spot.disc ? weights[0] * rule.slopes[0][q] / rule.slopes[0][0] : 0.0);
    }
    return spot;
}

double dea_rings_displacement(const dea_rings *rings, const dea_rings_spot *spot, const double *u, double *slope)
{
    const size_t first = spot->disc ? 0 : rings->mesh.disc;
    double sum = 0.0;
    *slope = 0.0;
    for (size_t q = 0; q <= spot->degree; q++) {
        const size_t node = first + q;
        const double at = node == 0 || node > rings->node_count ? 0.0 : u[node - 1];
        sum += spot->value[q] * at;
        *slope += spot->slope[q] * at;
    }
    return sum;
}

double dea_rings_value(const dea_rings *rings, const dea_rings_spot *spot, const double *values, size_t stride)
{
    const size_t centre = spot->disc ? 1 : 0; /* it has no ring */
    double sum = 0.0;
    for (size_t q = centre; q <= spot->degree; q++) {
        sum += spot->even[q] * values[stride * (spot->disc ? q - 1 : rings->mesh.disc + q)];
    }
    return sum;
}
