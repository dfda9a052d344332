/* In the plane of e = lambda_2 - lambda_pre and D = lambda_2 - lambda_1 the membrane (physics.md, section 3) is one equation of
 * first order without the radius, because x = ln R does not appear in it and de/dx = -D:
 *
 *     ds1/de = -Q,   Q = (P2 - P1)/D + k l1 l2,   from the edge, e = a, to the frame, e = 0
 *     dD/de = r,     r = 1 + (Q + s12)/s11
 *     ln(1/B) = int_0^a de/D:   D_frame = B^2 D_edge exp(-Psi),   Psi = int_0^a (r - 2)/D de
 *
 * r is 2 where D is 0, so that D(e) of Lame's solution is a straight line whatever the coverage, and a few Chebyshev nodes in e have
 * it to many digits at any strain that a film stands. The unknowns are D at the nodes and a; s1 is continuous at the edge. Newton:
 * with y = s11 dD at constant e the linearised equation is dy/de = q y + d(rho)/de, rho its residual, q = (dQ/dD)/s11, solved by
 * the integrating factor exp(int q), so that no matrix is needed. */
#include "model/field.h"

#include "model/models.h"
#include "support/lanes.h"

enum { DEGREE_MAX = 16, NODES_MAX = DEGREE_MAX + 1, ROUNDS_MAX = 24, STEPS_MAX = 12 };

/* Degrees, one after the other until the error is small enough. */
static const int degrees[] = {4, 5, 6, 8, 11, DEGREE_MAX};
enum { DEGREES = sizeof degrees / sizeof *degrees };

typedef double lanes __attribute__((vector_size(8 * DEA_LANES)));

/* Chebyshev-Lobatto nodes on [0, 1], from frame to edge. */
typedef struct rule {
    int degree;
    double places[NODES_MAX];
    double sums[NODES_MAX][NODES_MAX];   /* [j][i]: int from node j to 1 of polynomial i */
    double slopes[NODES_MAX][NODES_MAX]; /* [j][i]: slope of polynomial i at node j */
    double last[3][NODES_MAX];           /* values to the coefficients of degree n, n - 1, n - 2 */
} rule;

/* cos(pi m/n) for whole m, from the table of a turn. */
static double cosine_of(int n, const double *turn, int m)
{
    return turn[m % (2 * n)];
}

/* int_{x_j}^{1} T_k dx. */
static double chebyshev_integral(int n, const double *turn, int k, int j)
{
    const double x = cosine_of(n, turn, n - j);
    if (k < 2) {
        return k == 0 ? 1.0 - x : 0.5 * (1.0 - x * x);
    }
    return 0.5 * ((1.0 - cosine_of(n, turn, (k + 1) * (n - j))) / (k + 1) - (1.0 - cosine_of(n, turn, (k - 1) * (n - j))) / (k - 1));
}

/* Value at node i to the coefficient of degree k. */
static double to_coefficient(int n, const double *turn, int k, int i)
{
    const double ends = (k == 0 || k == n ? 0.5 : 1.0) * (i == 0 || i == n ? 0.5 : 1.0);
    return 2.0 / n * ends * cosine_of(n, turn, k * (n - i));
}

static void set_slopes(rule *r)
{
    const int n = r->degree;
    for (int j = 0; j <= n; j++) {
        double others = 0.0;
        for (int i = 0; i <= n; i++) {
            const double sign = (i + j) % 2 == 0 ? 1.0 : -1.0;
            const double ends = (i == 0 || i == n ? 0.5 : 1.0) / (j == 0 || j == n ? 0.5 : 1.0);
            r->slopes[j][i] = i == j ? 0.0 : sign * ends / (r->places[j] - r->places[i]);
            others += r->slopes[j][i];
        }
        r->slopes[j][j] = -others;
    }
}

static void make_rule(int n, rule *r)
{
    double turn[2 * DEGREE_MAX], integrals[NODES_MAX];
    r->degree = n;
    for (int m = 0; m < 2 * n; m++) {
        turn[m] = 2 * m == n || 2 * m == 3 * n ? 0.0 : cos(DEA_PI * m / n);
    }
    for (int j = 0; j <= n; j++) {
        r->places[j] = 0.5 * (1.0 + turn[n - j]);
        for (int k = 0; k <= n; k++) {
            integrals[k] = 0.5 * chebyshev_integral(n, turn, k, j);
        }
        for (int i = 0; i <= n; i++) {
            r->sums[j][i] = 0.0;
            for (int k = 0; k <= n; k++) {
                r->sums[j][i] += to_coefficient(n, turn, k, i) * integrals[k];
            }
        }
        for (int c = 0; c < 3; c++) {
            r->last[c][j] = to_coefficient(n, turn, n - c, j);
        }
    }
    set_slopes(r);
}

/* Films abreast under shares of their loads; those whose `live` is 0 stay as they are. */
typedef struct batch {
    lanes k;            /* eps (U/H)^2 under the share [Pa] */
    lanes square, rest; /* B^2 and 1 - B^2 */
    lanes edge;         /* a */
    lanes d[NODES_MAX]; /* D */
    lanes live;         /* 1 or 0 */
    lanes moved;        /* sum of the squares of relative changes in the last step */
    lanes stiffness;    /* of the edge: change of the load that moves it by da, over da [Pa] */
    const dea_film *film;
    const rule *rule;
    bool dot;
} batch;

/* The film at one node of each lane. */
typedef struct node {
    lanes l1, l2;
    lanes p1, p2;        /* changes of nominal stress of the passive film [Pa] */
    lanes s1;            /* change of P1 - k l1 l2^2 */
    lanes q, s11, r, dq; /* Q, s11, r, (dQ/dD)/s11 */
} node;

/* Stresses and moduli of the passive film at the nodes and, behind them, in the disc. */
typedef struct answers {
    lanes p1[NODES_MAX + 1], p2[NODES_MAX + 1], w11[NODES_MAX + 1], w12[NODES_MAX + 1];
} answers;

DEA_INLINE void ask(const batch *b, answers *at)
{
    lanes e1[NODES_MAX + 1], e2[NODES_MAX + 1];
    const int n = b->rule->degree;
    const double over = 1.0 / b->film->prestretch;
    for (int j = 0; j <= n; j++) {
        e2[j] = b->edge * (b->rule->places[j] * over);
        e1[j] = e2[j] - b->d[j] * over;
    }
    e1[n + 1] = e2[n + 1] = b->edge * over;
    const dea_biaxials out = {(double *)at->p1, (double *)at->p2, (double *)at->w11, (double *)at->w12};
    dea_film_biaxials(b->film, (size_t)(n + 2) * DEA_LANES, (const double *)e1, (const double *)e2, &out);
}

/* Node j from the answers. */
DEA_INLINE void look(const batch *b, const answers *at, int j, node *p)
{
    const double pre = b->film->prestretch;
    const lanes k = b->dot ? 0.0 * b->k : b->k;
    const lanes change2 = b->edge * b->rule->places[j], change1 = change2 - b->d[j];
    p->l1 = pre + change1;
    p->l2 = pre + change2;
    p->p1 = at->p1[j];
    p->p2 = at->p2[j];
    const lanes shear = (p->p2 - p->p1) / b->d[j];
    const lanes s12 = at->w12[j] - 2.0 * k * p->l1 * p->l2;
    p->s11 = at->w11[j] - k * p->l2 * p->l2;
    p->s1 = p->p1 - k * (pre * pre * change1 + p->l1 * change2 * (2.0 * pre + change2)); /* l1 l2^2 - lambda_pre^3 */
    p->q = shear + k * p->l1 * p->l2;
    const lanes over = 1.0 / p->s11;
    p->r = 1.0 + (p->q + s12) * over;
    p->dq = ((at->w11[j] - at->w12[j] - shear) / b->d[j] - k * p->l2) * over; /* d shear/dl1 = (w12 - w11 + shear)/D */
}

/* e^x - 1 by its series, to rounding for |x| < 1. */
DEA_INLINE void grow(const lanes *x, lanes *out)
{
    lanes sum = 1.0 + 0.0 * *x;
    for (int n = 18; n > 1; n--) {
        sum = 1.0 + *x * (1.0 / n) * sum;
    }
    *out = *x * sum;
}

/* int from node j to the edge of values at the nodes, over a. */
DEA_INLINE void sum_from(const rule *r, int j, const lanes *values, lanes *out)
{
    lanes sum = 0.0 * values[0];
    for (int i = 0; i <= r->degree; i++) {
        sum += r->sums[j][i] * values[i];
    }
    *out = sum;
}

/* int z/D^2 de over the film, z r smooth: by parts with -d(1/D) = r/D^2 de, z_frame/D_frame - z_edge/D_edge + int z'/D de. */
DEA_INLINE void reach_of(const batch *b, const lanes *weights, const lanes *z, lanes *out)
{
    const int n = b->rule->degree;
    lanes sum = z[0] / b->d[0] - z[n] / b->d[n];
    for (int i = 0; i <= n; i++) {
        sum += weights[i] * z[i];
    }
    *out = sum;
}

/* Residuals along the film, and y = held + fall y_edge. */
DEA_INLINE void along(const batch *b, const node *nodes, lanes *residual, lanes *fall, lanes *held)
{
    const int n = b->rule->degree;
    lanes q[NODES_MAX], dq[NODES_MAX], driven[NODES_MAX];
    for (int j = 0; j <= n; j++) {
        q[j] = nodes[j].q;
        dq[j] = nodes[j].dq;
    }
    for (int j = 0; j <= n; j++) {
        lanes sum, half;
        sum_from(b->rule, j, q, &sum);
        sum_from(b->rule, j, dq, &half);
        half *= 0.5 * b->edge;
        residual[j] = nodes[j].s1 - nodes[n].s1 - b->edge * sum;
        const lanes third = half * half * (1.0 / 3.0);
        fall[j] = (1.0 - half + third) / (1.0 + half + third); /* exp(-2 half) to order 5: the step alone feels its error */
        driven[j] = dq[j] * residual[j] / fall[j];
    }
    for (int j = 0; j <= n; j++) {
        lanes sum;
        sum_from(b->rule, j, driven, &sum);
        held[j] = residual[j] - fall[j] * b->edge * sum;
    }
}

/* One step of Newton. */
DEA_INLINE void step_body(batch *b)
{
    const int n = b->rule->degree;
    answers at;
    node nodes[NODES_MAX];
    lanes residual[NODES_MAX], fall[NODES_MAX], held[NODES_MAX];
    ask(b, &at);
    lanes psi = 0.0 * b->edge, gain = psi;
    for (int j = 0; j <= n; j++) {
        look(b, &at, j, &nodes[j]);
        gain += b->rule->sums[0][j] * nodes[j].r;
        psi += b->rule->sums[0][j] * ((nodes[j].r - 2.0) / b->d[j]);
    }
    psi *= b->edge;
    along(b, nodes, residual, fall, held);
    /* the frame: int de/D - ln(1/B) = 1/2 ln(D_edge/D_frame) - Psi/2 - ln(1/B), D_edge = D_frame + int D' de, with r for D'; and
     * what that leaves out as long as D' is not r, by D' - r = -(d rho/de)/s11 */
    lanes more, weights[NODES_MAX], free_z[NODES_MAX], held_z[NODES_MAX], free_reach, held_reach;
    grow(&psi, &more);
    lanes miss = 0.5 * (gain * b->edge - b->d[0] * (more + b->rest) / b->square) / b->d[n];
    for (int i = 0; i <= n; i++) {
        lanes slope = 0.0 * psi;
        weights[i] = 0.0 * psi;
        for (int j = 0; j <= n; j++) {
            slope += b->rule->slopes[i][j] * residual[j];
        }
        miss += 0.5 * b->rule->sums[0][i] * slope / nodes[i].s11 * (1.0 / b->d[i] - 1.0 / b->d[n]);
        for (int j = 0; j <= n; j++) {
            weights[i] += b->rule->slopes[j][i] * (b->rule->sums[0][j] / b->d[j]);
        }
        const lanes over = 1.0 / (nodes[i].s11 * nodes[i].r);
        free_z[i] = fall[i] * over;
        held_z[i] = held[i] * over;
    }
    reach_of(b, weights, free_z, &free_reach);
    reach_of(b, weights, held_z, &held_reach);
    /* the edge: s1 of annulus and disc */
    const lanes l = nodes[n].l2, load = b->dot ? b->k * l * l * l : -b->k * nodes[n].l1 * l * l;
    const lanes jump = nodes[n].p1 - at.p1[n + 1] + load;
    const lanes disc = at.w11[n + 1] + at.w12[n + 1] - (b->dot ? 3.0 * b->k * l * l : 0.0 * l);
    const lanes rise = nodes[n].q + disc, stiff = 1.0 / b->d[n] + rise * free_reach;
    const lanes move = (jump * free_reach + held_reach - miss) / stiff;
    const lanes y = jump - rise * move;
    b->stiffness = stiff / free_reach;
    b->moved = (move / b->edge) * (move / b->edge);
    for (int j = 0; j <= n; j++) {
        const lanes change = nodes[j].r * (b->rule->places[j] * move) + (held[j] + fall[j] * y) / nodes[j].s11;
        b->moved += (change / b->d[j]) * (change / b->d[j]);
        b->d[j] += b->live * change;
    }
    b->edge += b->live * move;
}

DEA_LANES_DISPATCH(step, step_body, (batch *b), (b))

/* What rows and errors need of a batch that has settled. */
typedef struct findings {
    lanes radial, hardness;    /* lambda_1 and s11 behind the edge [1], [Pa] */
    lanes area[NODES_MAX];     /* lambda_1 lambda_2 at the nodes [1] */
    lanes slack[NODES_MAX];    /* nominal hoop stress there, turned over [Pa] */
    lanes stress;              /* smallest nominal stress of the disc, and s1 at the nodes [Pa]: s1 is least at an end or at s2 */
    lanes far;                 /* lambda_1 lambda_2 where D would be 0, nearly [1] */
    lanes spread;              /* int (lambda_1 lambda_2 - far)^2 R dR over R_a^2/2: smooth where D is small */
    lanes coefficients[3][3];  /* the last three, from the last on, of r, of Q/s11 and of what spread is the sum of */
} findings;

DEA_INLINE void lower(lanes *least, const lanes *value)
{
    DEA_EACH_LANE(l)
    {
        (*least)[l] = (*value)[l] < (*least)[l] ? (*value)[l] : (*least)[l];
    }
}

DEA_INLINE void measure_body(const batch *b, findings *f)
{
    const int n = b->rule->degree;
    const double pre = b->film->prestretch, tension = b->film->tension;
    answers at;
    node nodes[NODES_MAX];
    lanes rate[NODES_MAX], traces[3][NODES_MAX];
    ask(b, &at);
    const lanes k = b->dot ? 0.0 * b->k : b->k, l = pre + b->edge;
    f->stress = tension + at.p1[n + 1] - (b->dot ? b->k * l * l * l : 0.0 * k);
    f->spread = 0.0 * k;
    lanes falls = f->spread;
    for (int j = 0; j <= n; j++) {
        look(b, &at, j, &nodes[j]);
        rate[j] = (nodes[j].r - 2.0) / b->d[j];
        const lanes area = nodes[j].l1 * nodes[j].l2;
        const lanes s1 = tension + nodes[j].p1 - k * area * nodes[j].l2, s2 = tension + nodes[j].p2 - k * area * nodes[j].l1;
        lower(&f->stress, &s1);
        f->slack[j] = -s2;
        f->area[j] = area;
        falls = j == 0 ? (nodes[j].l1 + nodes[j].l2 * (1.0 - nodes[j].r)) / nodes[j].r : falls; /* d(l1 l2)/dD at the frame */
    }
    f->far = f->area[0] - b->d[0] * falls;
    for (int j = 0; j <= n; j++) {
        lanes psi, more;
        sum_from(b->rule, j, rate, &psi);
        psi *= -b->edge;
        grow(&psi, &more);
        const lanes off = (f->area[j] - f->far) / b->d[j];
        traces[0][j] = nodes[j].r;
        traces[1][j] = nodes[j].q / nodes[j].s11;
        traces[2][j] = 2.0 * off * off * (1.0 + more) * b->d[n] * b->edge;
        f->spread += b->rule->sums[0][j] * traces[2][j];
    }
    for (int t = 0; t < 3; t++) {
        for (int c = 0; c < 3; c++) {
            f->coefficients[t][c] = 0.0 * k;
            for (int j = 0; j <= n; j++) {
                f->coefficients[t][c] += b->rule->last[c][j] * traces[t][j];
            }
        }
    }
    f->radial = nodes[n].l1;
    f->hardness = nodes[n].s11;
}

DEA_LANES_DISPATCH(measure, measure_body, (const batch *b, findings *f), (b, f))

/* A place on the way from rest to the full load. */
typedef struct place {
    double share;             /* of the load */
    double edge, radial;      /* a, and lambda_1 behind the edge */
    double stiffness;         /* of the edge [Pa] */
    double hardness;          /* s11 behind the edge [Pa] */
} place;

/* One lane on its way. */
typedef struct traveller {
    const dea_point *point;
    size_t number;
    double load; /* eps (U/H)^2 [Pa] */
    place here;
    double d[NODES_MAX];
    double target;
    double step, last; /* of Newton */
    bool settles, lost, there;
} traveller;

static place rest_of(const dea_point *point)
{
    const double b = point->coverage;
    return (place){0.0, 0.0, point->film.prestretch, 2.0 * point->film.w11 / ((1.0 - b) * (1.0 + b)), point->film.w11};
}

/* Lame's answer under a share of the load, as near rest, or the last place scaled. */
static void guess(const traveller *t, const rule *r, batch *b, size_t l)
{
    const dea_film *film = &t->point->film;
    const double b2 = b->square[l], rest = b->rest[l], m = t->load * t->target;
    b->k[l] = m;
    if (t->here.share > 0.0) {
        const double scale = t->target / t->here.share;
        b->edge[l] = t->here.edge * scale;
        for (int j = 0; j <= r->degree; j++) {
            b->d[j][l] = t->d[j] * scale;
        }
        return;
    }
    const double softening = m * film->square * (b->dot ? 3.0 : (1.0 + b2) / rest - 2.0);
    const double strain = m * film->square * film->prestretch / (2.0 * film->w11 / rest - softening);
    b->edge[l] = b->dot ? strain : -strain;
    for (int j = 0; j <= r->degree; j++) {
        b->d[j][l] = b->edge[l] * (2.0 * r->places[j] + 2.0 * b2 / rest);
    }
}

/* Newton's next step goes with the square of this one, by a factor that the last two tell. */
static bool has_settled(const traveller *t, double accuracy)
{
    const double factor = fmax(10.0, t->step / (t->last * t->last));
    return factor * t->step * t->step <= fmax(0.02 * accuracy, 1e-14);
}

static void iterate(batch *b, traveller *ways, double accuracy)
{
    DEA_EACH_LANE(l)
    {
        ways[l].settles = false;
        ways[l].step = 1.0;
        b->live[l] = ways[l].point && !ways[l].there && !ways[l].lost ? 1.0 : 0.0;
    }
    for (int i = 0; i < STEPS_MAX; i++) {
        bool any = false;
        step(b);
        DEA_EACH_LANE(l)
        {
            if (b->live[l] > 0.0) {
                ways[l].last = ways[l].step;
                ways[l].step = sqrt(b->moved[l]);
                ways[l].settles = has_settled(&ways[l], accuracy);
                const bool ends = ways[l].settles || !isfinite(ways[l].step);
                b->live[l] = ends ? 0.0 : 1.0;
                any = any || !ends;
            }
        }
        if (!any) {
            break;
        }
    }
}

/* Longest way, as changes of stretches behind the edge, and the smallest ratio of what may not change its sign on it. */
static const double longest_way = 0.15, alike = 0.5, hard = 0.3;
static const double shortest_share = 1.0 / 64.0;

static bool near(double a, double b, double ratio)
{
    return fmin(a, b) > ratio * fmax(a, b);
}

/* True where no fold and no end of the film can lie between two places: over so short a way the stiffness at both, and its mean
 * from the load between them, leave no room for a zero. */
static bool connected(const traveller *t, const place *next, double sign)
{
    const place *from = &t->here;
    const double pre = t->point->film.prestretch, l = pre + 0.5 * (from->edge + next->edge);
    const double mean = sign * t->load * (next->share - from->share) * l * l * l / (next->edge - from->edge);
    return fabs(next->radial - from->radial) <= longest_way * fmin(next->radial, from->radial) &&
           fabs(next->edge - from->edge) <= longest_way * pre && near(from->stiffness, next->stiffness, alike) &&
           near(mean, next->stiffness, alike) && near(from->hardness, next->hardness, hard);
}

/* Goes to where a lane has settled, or asks for less. */
static void go_on(traveller *t, const batch *b, const findings *f, size_t l)
{
    const place next = {t->target, b->edge[l], f->radial[l], b->stiffness[l], f->hardness[l]};
    const double way = t->target - t->here.share;
    if (t->settles && connected(t, &next, b->dot ? 1.0 : -1.0)) {
        t->there = t->target == 1.0;
        t->here = next;
        for (int j = 0; j <= b->rule->degree; j++) {
            t->d[j] = b->d[j][l];
        }
        t->target = fmin(1.0, t->target + way);
    } else {
        t->target = t->here.share + 0.5 * way;
        t->lost = way <= shortest_share;
    }
}

/* Error that the last coefficients of a function leave in its integral: they fall by their ratio from one to the next, and the next
 * but one is the first that the nodes take for another, T_(n+2) for T_(n-2), whose mean is no more than a third. */
static double tail(const double *last)
{
    const double first = fabs(last[0] / last[1]), second = fabs(last[0] / last[2]);
    const double fall = fmin(1.0, fmax(first * first, second));
    return isfinite(fall) ? fabs(last[0]) * fall / 3.0 : fabs(last[0]);
}

/* A square falls slower than its root, whose coefficients the ratio of the last ones takes for the next: measured, by up to three. */
static const double of_square = 3.0;

/* Estimated relative error of strain and capacitance: what the sums leave out, over the share of its stiffness that the film has
 * left. */
static double error_of(const traveller *t, const findings *f, size_t l)
{
    const dea_point *point = t->point;
    const double b = point->coverage, apart = of_square * b * b / ((1.0 - b) * (1.0 + b)) / (point->film.square * point->film.square);
    const double softened = fmax(1.0, rest_of(point).stiffness / t->here.stiffness);
    const double weights[] = {softened, softened, point->kind == DEA_DOT ? 0.0 : apart};
    double error = 0.0;
    for (int k = 0; k < 3; k++) {
        const double last[] = {f->coefficients[k][0][l], f->coefficients[k][1][l], f->coefficients[k][2][l]};
        error = fmax(error, weights[k] * tail(last));
    }
    return error;
}

/* The polynomial through the values of a lane at the nodes, by the barycentric formula. */
static double value_at(const rule *r, const lanes *values, size_t l, double x)
{
    double above = 0.0, below = 0.0;
    for (int j = 0; j <= r->degree; j++) {
        const double ends = j == 0 || j == r->degree ? 0.5 : 1.0, off = x - r->places[j];
        if (off == 0.0) {
            return values[j][l];
        }
        const double weight = (j % 2 == 0 ? ends : -ends) / off;
        above += weight * values[j][l];
        below += weight;
    }
    return above / below;
}

/* The largest value along the film, most often that at one end: else next to the largest of the nodes, by golden section. */
static double largest(const rule *r, const lanes *values, size_t l)
{
    const double golden = 0.6180339887498949;
    int most = 0;
    for (int j = 1; j <= r->degree; j++) {
        most = values[j][l] > values[most][l] ? j : most;
    }
    double low = r->places[most > 0 ? most - 1 : 0], high = r->places[most < r->degree ? most + 1 : most];
    double best = values[most][l];
    if (most == 0 || most == r->degree) {
        double slope = 0.0;
        for (int j = 0; j <= r->degree; j++) {
            slope += r->slopes[most][j] * values[j][l];
        }
        if (most == 0 ? slope <= 0.0 : slope >= 0.0) {
            return best;
        }
    }
    for (int i = 0; i < 40; i++) {
        const double x1 = high - golden * (high - low), x2 = low + golden * (high - low);
        const double y1 = value_at(r, values, l, x1), y2 = value_at(r, values, l, x2);
        *(y1 > y2 ? &high : &low) = y1 > y2 ? x2 : x1;
        best = fmax(best, fmax(y1, y2));
    }
    return best;
}

/* (l1 l2)^2 = far (2 l1 l2 - far) + (l1 l2 - far)^2, and the mean of l1 l2 over the annulus is what the radii of its ends make it. */
static void fill(const rule *r, const traveller *t, const findings *f, size_t l, dea_row *row)
{
    const dea_point *point = t->point;
    const dea_film *film = &point->film;
    const bool dot = point->kind == DEA_DOT;
    const double b = point->coverage, rest = (1.0 - b) * (1.0 + b), strain = t->here.edge / film->prestretch;
    const double stretch = film->prestretch + t->here.edge;
    const double mean = 1.0 - b * b * strain * (2.0 + strain) / rest; /* over lambda_pre^2 */
    const double far = f->far[l] / film->square;
    const double annulus = far * (2.0 * mean - far) + b * b / rest * f->spread[l] / (film->square * film->square);
    dea_field_fill(point,
                   (dea_field_found){.strain = strain,
                                     .edge_force = (dot ? stretch : f->radial[l]) * stretch * stretch,
                                     .stretch = dot ? stretch * stretch : largest(r, f->area, l),
                                     .capacitance = dot ? dea_point_disc_capacitance(point, strain)
                                                        : dea_point_capacitance(point) * annulus,
                                     .taut = fmin(f->stress[l], -largest(r, f->slack, l)) > 0.0},
                   row);
}

/* Up to DEA_LANES travellers, from rest to the full load as far as they come; those at its end have an error. */
static void travel(const rule *r, traveller *ways, double accuracy, findings *f)
{
    batch b = {.film = &ways[0].point->film, .rule = r, .dot = ways[0].point->kind == DEA_DOT};
    bool any = true;
    DEA_EACH_LANE(l)
    {
        const double coverage = ways[l].point ? ways[l].point->coverage : 0.5;
        b.square[l] = coverage * coverage;
        b.rest[l] = (1.0 - coverage) * (1.0 + coverage);
        b.edge[l] = 1e-3; /* an idle lane: any film */
        for (int j = 0; j <= r->degree; j++) {
            b.d[j][l] = 1e-3 * (1.0 + r->places[j]);
        }
    }
    for (int i = 0; i < ROUNDS_MAX && any; i++) {
        DEA_EACH_LANE(l)
        {
            if (ways[l].point && !ways[l].there && !ways[l].lost) {
                guess(&ways[l], r, &b, l);
            }
        }
        iterate(&b, ways, accuracy);
        measure(&b, f);
        any = false;
        DEA_EACH_LANE(l)
        {
            if (ways[l].point && !ways[l].there && !ways[l].lost) {
                go_on(&ways[l], &b, f, l);
                any = any || !(ways[l].there || ways[l].lost);
            }
        }
    }
}

/* Place in the list of degrees at which to begin: coefficients fall about as the strain of Lame's film from one to the next. */
static int first_degree(const dea_point *point, double load, double accuracy)
{
    const dea_film *film = &point->film;
    const double rest = (1.0 - point->coverage) * (1.0 + point->coverage);
    const double fall = fmin(0.5, load * film->square * rest / (2.0 * film->w11));
    const double wanted = log(3.0 * accuracy) / log(fall) - 2.0;
    int first = 0;
    while (first + 1 < DEGREES && degrees[first] < wanted) {
        first++;
    }
    return first;
}

/* One group of points with one rule: those whose error is small enough are solved, and those that are lost given up. */
static void solve_group(const rule *r, traveller *ways, double accuracy, dea_row *rows, bool *solved, int *next)
{
    findings f;
    travel(r, ways, accuracy, &f);
    DEA_EACH_LANE(l)
    {
        const traveller *t = &ways[l];
        if (t->point && t->there && error_of(t, &f, l) <= accuracy) {
            fill(r, t, &f, l, &rows[t->number]);
            solved[t->number] = true;
        } else if (t->point) {
            next[t->number] = t->there ? next[t->number] + 1 : DEGREES;
        }
    }
}

enum { CHUNK = 256 };

static void solve_chunk(const dea_point *points, size_t count, double accuracy, dea_row *rows, bool *solved)
{
    int next[CHUNK];
    double loads[CHUNK];
    for (size_t i = 0; i < count; i++) {
        const double nominal = dea_point_nominal_field(&points[i]);
        loads[i] = points[i].film.permittivity * nominal * nominal;
        solved[i] = false;
        const dea_film *film = &points[i].film;
        const bool plain = points[i].skin_share == 0.0 && points[i].load == 0.0 && film->w11 > 0.0 && film->electrostriction == 0.0;
        next[i] = plain && loads[i] > 0.0 && isfinite(loads[i]) ? first_degree(&points[i], loads[i], accuracy) : DEGREES;
    }
    for (int d = 0; d < DEGREES; d++) {
        rule r = {0};
        size_t i = 0;
        while (i < count) {
            traveller ways[DEA_LANES];
            size_t lanes_used = 0;
            for (; i < count && lanes_used < DEA_LANES; i++) {
                if (!solved[i] && next[i] == d) {
                    ways[lanes_used++] = (traveller){
                        .point = &points[i], .number = i, .load = loads[i], .here = rest_of(&points[i]), .target = 1.0};
                }
            }
            if (lanes_used == 0) {
                break;
            }
            for (size_t l = lanes_used; l < DEA_LANES; l++) {
                ways[l] = (traveller){0};
            }
            if (r.degree == 0) {
                make_rule(degrees[d], &r);
            }
            solve_group(&r, ways, accuracy, rows, solved, next);
        }
    }
}

void dea_collocation_solve(const dea_point *points, size_t count, double accuracy, dea_row *rows, bool *solved)
{
    for (size_t i = 0; i < count; i += CHUNK) {
        solve_chunk(points + i, count - i < CHUNK ? count - i : CHUNK, accuracy, rows + i, solved + i);
    }
}
