#include "engine/direct/piece.h"

/* i omega and its multiples. */
static double complex harmonic(const dea_piece *piece, int number)
{
    return dea_complex(0.0, (number + 1) * piece->omega);
}

/* U^2 of o + A sin(x): o^2 + A^2/2 + Re(-2 i o A e^{ix} - A^2/2 e^{2ix}). */
static void set_sine(dea_piece *piece, const dea_modes *modes)
{
    const dea_tone *sine = &piece->signal->curve.tones[0];
    const double o = piece->signal->curve.offset;
    const double a = sine->amplitude;
    piece->omega = 2.0 * DEA_PI * sine->frequency;
    piece->force = (dea_forcing){piece->per_square * (o * o + 0.5 * a * a), 0.0, 0.0};
    const double complex turn = dea_piece_turn(piece, 0.0);
    piece->harmonics[0] = -2.0 * I * piece->per_square * o * a * turn;
    piece->harmonics[1] = -0.5 * piece->per_square * a * a * turn * turn;
    for (int k = 0; k < DEA_HARMONICS; k++) {
        piece->displacement[k] = piece->harmonics[k] / dea_chain_stiffness(&modes->chain, harmonic(piece, k));
    }
}

dea_piece dea_piece_make(const dea_signal *signal, const dea_segment *segment, const dea_linear *linear, const dea_modes *modes)
{
    dea_piece piece = {.signal = signal, .segment = segment, .length = segment->to - segment->from, .per_square = linear->force};
    if (segment->sine) {
        set_sine(&piece, modes);
        return piece;
    }
    const double rise = (segment->end - segment->start) / piece.length;
    piece.force = (dea_forcing){linear->force * segment->start * segment->start, 2.0 * linear->force * segment->start * rise,
                                2.0 * linear->force * rise * rise};
    return piece;
}

dea_forcing dea_piece_force(const dea_piece *piece, double t)
{
    if (piece->omega > 0.0 || (piece->force.slope == 0.0 && piece->force.bend == 0.0)) {
        return piece->force;
    }
    const dea_segment *segment = piece->segment;
    const double rise = (segment->end - segment->start) / piece->length;
    const double voltage = t >= piece->length ? segment->end : segment->start + rise * t;
    return (dea_forcing){piece->per_square * voltage * voltage, 2.0 * piece->per_square * voltage * rise, piece->force.bend};
}

double complex dea_piece_turn(const dea_piece *piece, double t)
{
    const dea_tone *sine = &piece->signal->curve.tones[0];
    const double turns = sine->frequency * (piece->segment->from + t - piece->segment->origin);
    const double angle = 2.0 * DEA_PI * (turns - floor(turns)) + sine->phase;
    return dea_complex(cos(angle), sin(angle));
}

/* e^{i omega t}. */
static double complex advance_turn(const dea_piece *piece, double t)
{
    const double turns = piece->signal->curve.tones[0].frequency * t;
    const double angle = 2.0 * DEA_PI * (turns - floor(turns));
    return dea_complex(cos(angle), sin(angle));
}

/* Harmonics included. From the time since the begin, which has more digits than the time itself. */
static double whole_force(const dea_piece *piece, double t)
{
    double complex sum = dea_piece_force(piece, t).value;
    if (piece->omega > 0.0) {
        const double complex turn = advance_turn(piece, t);
        sum += turn * (piece->harmonics[0] + turn * piece->harmonics[1]);
    }
    return creal(sum);
}

void dea_piece_shift(const dea_piece *piece, const dea_modes *modes, double t, double sign, dea_course *course)
{
    double complex turn = sign;
    for (int k = 0; k < DEA_HARMONICS && piece->omega > 0.0; k++) {
        turn *= advance_turn(piece, t);
        const double complex s = harmonic(piece, k);
        const double complex force = turn * piece->harmonics[k];
        for (size_t j = 0; j < modes->count; j++) {
            const double complex part = force / (s - modes->roots[j].value) * modes->roots[j].residue;
            course->place.roots[j] += creal(part);
            course->speed.roots[j] += creal(s * part);
        }
        if (modes->pair) {
            /* (s - sigma - e)^-1 (even + odd e) */
            const double complex d = s - modes->sigma;
            const double complex factor = force / (d * d - modes->square);
            const double complex even = factor * (d * modes->residue.even + modes->square * modes->residue.odd);
            const double complex odd = factor * (modes->residue.even + d * modes->residue.odd);
            course->place.pair = dea_dual_add(course->place.pair, (dea_dual){creal(even), creal(odd)});
            course->speed.pair = dea_dual_add(course->speed.pair, (dea_dual){creal(s * even), creal(s * odd)});
        }
    }
}

double dea_piece_parts(const dea_piece *piece, const dea_modes *modes)
{
    double sum = 0.0;
    for (int k = 0; k < DEA_HARMONICS && piece->omega > 0.0; k++) {
        sum += cabs(piece->displacement[k]);
        for (size_t j = 0; j < modes->count; j++) {
            sum += cabs(piece->harmonics[k] * modes->roots[j].residue / (harmonic(piece, k) - modes->roots[j].value));
        }
    }
    return sum;
}

dea_motion dea_piece_motion(const dea_piece *piece, const dea_modes *modes, const dea_course *course, double t)
{
    const dea_forcing force = dea_piece_force(piece, t);
    dea_motion motion = {dea_modes_displacement(modes, course, &force), dea_modes_velocity(modes, course, &force)};
    if (piece->omega > 0.0) {
        const double complex turn = advance_turn(piece, t);
        const double complex first = turn * piece->displacement[0];
        const double complex second = turn * turn * piece->displacement[1];
        motion.u += creal(first + second);
        motion.v -= piece->omega * cimag(first + 2.0 * second);
    }
    return motion;
}

/* Motion as a sum of exponentials, v = sum speed e^{s t}, z_i' = sum speed q_i/(s + q_i) e^{s t}, and a drift. */
typedef struct exponential {
    double complex s, speed;
    const dea_root *root; /* NULL: not a real root */
} exponential;

enum { EXPONENTIALS = DEA_MODES_MAX + 2 + 2 * DEA_HARMONICS };

/* Velocity that goes with a ramp once the modes have settled: value + rise t. */
typedef struct drift {
    double value, rise; /* [m/s], [m/s^2] */
} drift;

static bool is_ramp(const dea_piece *piece)
{
    return piece->force.slope != 0.0 || piece->force.bend != 0.0;
}

/* A pair that is not clearly complex is no sum of two exponentials. On a ramp, a mode that is slower than the ramp would cancel
 * against the drift. */
static bool is_exponential(const dea_piece *piece, const dea_modes *modes)
{
    const double slowest = is_ramp(piece) ? 0.5 / piece->length : 0.0;
    for (size_t j = 0; j < modes->count; j++) {
        if (!(fabs(modes->roots[j].value) >= slowest)) {
            return false;
        }
    }
    return !modes->pair || (modes->square < -0.1 * modes->sigma * modes->sigma && modes->square <= -slowest * slowest);
}

/* F'/p(s) at s -> 0: F'/K - p'(0) F''/K^2 with p'(0) = r + sum k_i tau_i. */
static drift drift_of(const dea_piece *piece, const dea_modes *modes)
{
    const dea_chain *chain = &modes->chain;
    if (!is_ramp(piece)) {
        return (drift){0.0, 0.0};
    }
    double slope = chain->damping;
    for (size_t i = 0; i < chain->count; i++) {
        slope += chain->spring[i] * chain->tau[i];
    }
    const double rise = piece->force.bend / chain->stiffness;
    return (drift){(piece->force.slope - slope * rise) / chain->stiffness, rise};
}

/* Takes from the speeds their shares of the drift at the begin, -(F' + F''/s)/(s p'(s)). */
static void drop_drift(const dea_piece *piece, const dea_modes *modes, dea_amplitudes *speed)
{
    for (size_t j = 0; j < modes->count && is_ramp(piece); j++) {
        const dea_root *root = &modes->roots[j];
        speed->roots[j] += root->residue * (piece->force.slope + piece->force.bend / root->value) / root->value;
    }
    if (modes->pair && is_ramp(piece)) {
        const dea_dual s = {modes->sigma, 1.0};
        dea_dual share = dea_dual_div((dea_dual){piece->force.bend, 0.0}, s, modes->square);
        share.even += piece->force.slope;
        share = dea_dual_mul(modes->residue, dea_dual_div(share, s, modes->square), modes->square);
        speed->pair = dea_dual_add(speed->pair, share);
    }
}

static size_t list_exponentials(const dea_piece *piece, const dea_modes *modes, const dea_amplitudes *speed, exponential *list)
{
    size_t count = 0;
    for (size_t j = 0; j < modes->count; j++) {
        const dea_root *root = &modes->roots[j];
        list[count++] = (exponential){root->value, speed->roots[j], root};
    }
    if (modes->pair) {
        const double omega = sqrt(-modes->square);
        const dea_dual pair = speed->pair;
        list[count++] = (exponential){dea_complex(modes->sigma, omega), 0.5 * dea_complex(pair.odd, -pair.even / omega), NULL};
        list[count++] = (exponential){dea_complex(modes->sigma, -omega), 0.5 * dea_complex(pair.odd, pair.even / omega), NULL};
    }
    for (int k = 0; k < DEA_HARMONICS && piece->omega > 0.0; k++) {
        const double complex s = harmonic(piece, k);
        const double complex half = 0.5 * s * piece->displacement[k];
        list[count++] = (exponential){s, half, NULL};
        list[count++] = (exponential){conj(s), conj(half), NULL};
    }
    return count;
}

/* int_0^t e^{s x} dx. */
static double complex integral(double complex s, double t)
{
    const double x = creal(s) * t;
    const double y = cimag(s) * t;
    if (x == 0.0 && y == 0.0) {
        return t;
    }
    if (y == 0.0) {
        return expm1(x) / creal(s);
    }
    const double half = sin(0.5 * y);
    const double complex rise = dea_complex(expm1(x) * cos(y) - 2.0 * half * half, exp(x) * sin(y));
    return rise / s;
}

/* sum of k_i q_i/((s + q_i) (s' + q_i)): what the branches dissipate over the velocities of two exponentials. */
static double complex branch_share(const dea_chain *chain, const exponential *a, const exponential *b)
{
    double complex sum = 0.0;
    for (size_t i = 0; i < chain->count; i++) {
        const double complex first = a->root ? dea_root_above(chain, a->root, i) : a->s + chain->rate[i];
        const double complex second = b->root ? dea_root_above(chain, b->root, i) : b->s + chain->rate[i];
        sum += chain->spring[i] * (chain->rate[i] / first) / second;
    }
    return sum;
}

/* int t^n e^{s t} dt for n = 0, 1, 2: |s| times the length is not small where n > 0 is asked for. */
static void moments(const dea_piece *piece, double complex s, double complex moment[3])
{
    const double t = piece->length;
    const double complex end = cexp(s * t);
    moment[0] = integral(s, t);
    moment[1] = (t * end - moment[0]) / s;
    moment[2] = (t * t * end - 2.0 * moment[1]) / s;
}

/* int F v dt of an exponential, F = value + slope t + bend t^2/2 + sum of harmonics. */
static double push_of(const dea_piece *piece, const exponential *e)
{
    double complex sum = piece->force.value * integral(e->s, piece->length);
    if (is_ramp(piece)) {
        double complex moment[3];
        moments(piece, e->s, moment);
        sum += piece->force.slope * moment[1] + 0.5 * piece->force.bend * moment[2];
    }
    for (int k = 0; k < DEA_HARMONICS && piece->omega > 0.0; k++) {
        const double complex s = harmonic(piece, k);
        const double complex half = 0.5 * piece->harmonics[k];
        sum += half * integral(e->s + s, piece->length) + conj(half) * integral(e->s - s, piece->length);
    }
    return creal(sum * e->speed);
}

/* int (a.value + a.rise t) (b.value + b.rise t) dt. */
static double product_of(drift a, drift b, double t)
{
    return t * (a.value * b.value + t * (0.5 * (a.value * b.rise + a.rise * b.value) + t / 3.0 * a.rise * b.rise));
}

/* The drift of a branch, z_i' = v - tau_i v' of the drift. */
static drift branch_drift(const dea_chain *chain, drift v, size_t branch)
{
    return (drift){v.value - chain->tau[branch] * v.rise, v.rise};
}

/* What the drift takes by itself. */
static void spend_drift(const dea_piece *piece, const dea_chain *chain, drift v, dea_spent *spent)
{
    const double t = piece->length;
    const double curved = 0.5 * piece->force.bend * t * t * t * (v.value / 3.0 + 0.25 * t * v.rise);
    spent->push += product_of((drift){piece->force.value, piece->force.slope}, v, t) + curved;
    spent->damper += chain->damping * product_of(v, v, t);
    for (size_t i = 0; i < chain->count; i++) {
        const drift z = branch_drift(chain, v, i);
        spent->branches += chain->spring[i] * chain->tau[i] * product_of(z, z, t);
    }
}

/* What drift and one exponential take together. */
static void spend_mixed(const dea_piece *piece, const dea_chain *chain, drift v, const exponential *e, dea_spent *spent)
{
    double complex moment[3];
    moments(piece, e->s, moment);
    const double complex both = 2.0 * e->speed * (v.value * moment[0] + v.rise * moment[1]);
    spent->damper += chain->damping * creal(both);
    for (size_t i = 0; i < chain->count; i++) {
        const drift z = branch_drift(chain, v, i);
        const double complex above = e->root ? dea_root_above(chain, e->root, i) : e->s + chain->rate[i];
        spent->branches += creal(2.0 * chain->spring[i] / above * e->speed * (z.value * moment[0] + z.rise * moment[1]));
    }
}

static void spend_exponentials(const dea_piece *piece, const dea_modes *modes, const dea_course *start, dea_spent *spent)
{
    const dea_chain *chain = &modes->chain;
    const drift v = drift_of(piece, modes);
    dea_amplitudes speed = start->speed;
    exponential list[EXPONENTIALS];
    drop_drift(piece, modes, &speed);
    const size_t count = list_exponentials(piece, modes, &speed, list);
    for (size_t i = 0; i < count; i++) {
        spent->push += push_of(piece, &list[i]);
        if (is_ramp(piece)) {
            spend_mixed(piece, chain, v, &list[i], spent);
        }
        for (size_t k = i; k < count; k++) {
            const double complex product = list[i].speed * list[k].speed * (i == k ? 1.0 : 2.0);
            const double complex both = product * integral(list[i].s + list[k].s, piece->length);
            spent->damper += chain->damping * creal(both);
            spent->branches += creal(both * branch_share(chain, &list[i], &list[k]));
        }
    }
    spend_drift(piece, chain, v, spent);
}

/* Sixteen-point Gauss-Legendre rule on [0, 1], its lower half. */
enum { NODES = 16 };
static const double places[NODES / 2] = {0.00529953250417503370192, 0.0277124884633837119610, 0.0671843988060841280598,
                                         0.122297795822498483052,   0.191061877798678125777,  0.270991611171386306829,
                                         0.359198224610370543385,   0.452493745081181279907};
static const double weights[NODES / 2] = {0.0135762297058770474259, 0.0311267619693239464314, 0.0475792558412463924050,
                                          0.0623144856277669360262, 0.0747979944082883660408, 0.0845782596975012690947,
                                          0.0913017075224617944334, 0.0947253052275342481427};

/* Longest panel at time t: what decays is smooth on the scale of the time since the edge, what rings or grows on its own. */
static double panel_length(const dea_piece *piece, const dea_modes *modes, double t)
{
    double fastest = piece->omega;
    double steady = 2.0 * piece->omega;
    if (modes->pair) {
        const double omega = sqrt(fabs(modes->square));
        fastest = fmax(fastest, fmax(fabs(modes->sigma), omega));
        steady = modes->sigma * t > -40.0 ? fmax(steady, omega) : steady;
    }
    for (size_t j = 0; j < modes->count; j++) {
        fastest = fmax(fastest, fabs(modes->roots[j].value));
        steady = fmax(steady, modes->roots[j].value);
    }
    const double graded = fmax(t, 2.0 / fastest);
    return steady > 0.0 ? fmin(graded, 4.0 / steady) : graded;
}

static void spend_at(const dea_piece *piece, const dea_modes *modes, const dea_course *start, double t, double weight,
                     dea_spent *spent)
{
    const dea_chain *chain = &modes->chain;
    dea_advance advance;
    dea_course course = *start;
    double rates[DEA_PRONY_MAX];
    dea_advance_make(modes, t, &advance);
    dea_advance_take(modes, &advance, &piece->force, &course);
    const dea_motion motion = dea_piece_motion(piece, modes, &course, t);
    dea_piece_shift(piece, modes, t, 1.0, &course);
    dea_modes_branches(modes, &course.speed, rates);
    spent->push += weight * whole_force(piece, t) * motion.v;
    spent->damper += weight * chain->damping * motion.v * motion.v;
    for (size_t i = 0; i < chain->count; i++) {
        spent->branches += weight * chain->spring[i] * chain->tau[i] * rates[i] * rates[i];
    }
}

static void spend_panels(const dea_piece *piece, const dea_modes *modes, const dea_course *start, dea_spent *spent)
{
    double from = 0.0;
    while (from < piece->length) {
        const double length = fmin(panel_length(piece, modes, from), piece->length - from);
        for (int i = 0; i < NODES; i++) {
            const int k = i < NODES / 2 ? i : NODES - 1 - i;
            const double place = i < NODES / 2 ? places[k] : 1.0 - places[k];
            spend_at(piece, modes, start, from + place * length, weights[k] * length, spent);
        }
        from = from + length > from ? from + length : piece->length;
    }
}

static double squared_voltage(const dea_piece *piece)
{
    const dea_segment *segment = piece->segment;
    if (!segment->sine) {
        const double sum = segment->start * (segment->start + segment->end) + segment->end * segment->end;
        return piece->length * sum / 3.0;
    }
    const double o = piece->signal->curve.offset;
    const double a = piece->signal->curve.tones[0].amplitude;
    const double complex turn = dea_piece_turn(piece, 0.0);
    return piece->length * (o * o + 0.5 * a * a) +
           creal(-2.0 * I * o * a * turn * integral(I * piece->omega, piece->length) -
                 0.5 * a * a * turn * turn * integral(2.0 * I * piece->omega, piece->length));
}

dea_spent dea_piece_spend(const dea_piece *piece, const dea_modes *modes, const dea_course *start)
{
    dea_spent spent = {.square = squared_voltage(piece)};
    if (is_exponential(piece, modes)) {
        spend_exponentials(piece, modes, start, &spent);
    } else {
        spend_panels(piece, modes, start, &spent);
    }
    return spent;
}

double dea_piece_integral(const dea_piece *piece, const dea_modes *modes, const dea_course *start, double from, double to)
{
    dea_advance advance;
    dea_course course = *start;
    dea_advance_make(modes, from, &advance);
    dea_advance_take(modes, &advance, &piece->force, &course);
    dea_advance_make(modes, to - from, &advance);
    const dea_forcing force = dea_piece_force(piece, from);
    double complex sum = dea_advance_integral(modes, &advance, &force, &course);
    double complex turn = 1.0;
    for (int k = 0; k < DEA_HARMONICS && piece->omega > 0.0; k++) {
        turn *= advance_turn(piece, from);
        sum += piece->displacement[k] * turn * integral(harmonic(piece, k), to - from);
    }
    return creal(sum);
}
