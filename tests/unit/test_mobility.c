/* The network in the mobility analogy: what its netlist holds, and what ngspice makes of it in time and frequency. */
#include "random_transients.h"

#include <ctype.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/ngspice/track.h"

/* The paper's protocol on its film: 0 V, 4.5 kV from 5 s to 15 s, 0 V. */
static dea_scene protocol(const char *model)
{
    dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.5, (double)NAN);
    scene.models[0] = dea_model_find(model);
    scene.study = DEA_STUDY_TRANSIENT;
    scene.transient = (dea_transient){.until = 25.0, .every = 0.01};
    scene.drive.waveform = (dea_waveform){.kind = DEA_WAVE_STEP, .step = {5.0, 15.0, 4500.0, 1e-6}, .period = (double)NAN};
    return scene;
}

static void add_branches(dea_scene *scene)
{
    scene->material.prony_count = 3;
    scene->material.prony[0] = (dea_prony){0.1, 0.03};
    scene->material.prony[1] = (dea_prony){0.1, 0.3};
    scene->material.prony[2] = (dea_prony){0.05, 3.0};
}

/* Netlist of the whole run as one piece; the caller frees it. */
static char *netlist_of(const dea_scene *scene)
{
    dea_error error = {0};
    dea_dynamics dynamics;
    dea_mobility mobility;
    dea_signal signal;
    char *text = NULL;
    assert_int_equal(dea_dynamics_open(scene, scene->models[0], &dynamics, &error), DEA_OK);
    assert_int_equal(dea_mobility_open(scene, &dynamics, &mobility, &error), DEA_OK);
    assert_int_equal(dea_signal_open(scene, &signal, &error), DEA_OK);
    const dea_mobility_piece piece = {
        .signal = &signal, .to = scene->transient.until, .step = 1e-3, .loose = 1.0, .scale = 1e-3, .force = 1.0, .mass = dynamics.mass};
    assert_int_equal(dea_mobility_write(&mobility, &piece, &text, &error), DEA_OK);
    dea_signal_close(&signal);
    dea_mobility_close(&mobility);
    dea_dynamics_close(&dynamics);
    return text;
}

/* Cards that begin with a word. */
static size_t cards(const char *netlist, const char *word)
{
    size_t count = 0;
    const size_t length = strlen(word);
    for (const char *line = netlist; line; line = strchr(line, '\n') ? strchr(line, '\n') + 1 : NULL) {
        count += strncmp(line, word, length) == 0;
    }
    return count;
}

static void assert_cards(const dea_scene *scene, const char *word, size_t count)
{
    char *netlist = netlist_of(scene);
    if (cards(netlist, word) != count) {
        print_error("%s of %s: %zu, wanted %zu\n", word, scene->models[0]->name, cards(netlist, word), count);
        fail();
    }
    free(netlist);
}

static void network_has_the_elements_of_the_scene_and_no_other(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "lame", "coverage"};
    for (int i = 0; i < 3; i++) {
        dea_scene scene = protocol(models[i]);
        const bool linear = scene.models[0]->linear != NULL;
        assert_cards(&scene, "CMASS", 0);
        assert_cards(&scene, "LSPRING", linear ? 1 : 0);
        assert_cards(&scene, "BSPRING", linear ? 0 : 1);
        assert_cards(&scene, "R", 0);
        assert_cards(&scene, "C", linear ? 0 : 1);
        assert_cards(&scene, "BFORCE", 1);
        scene.material.density = 1080.0;
        assert_cards(&scene, "CMASS", 1);
        add_branches(&scene);
        assert_cards(&scene, linear ? "LBRANCH" : "GBRANCH", 3);
        assert_cards(&scene, linear ? "RBRANCH" : "CBRANCH", 3);
        scene.material.retardation = 1e-4;
        assert_cards(&scene, linear ? "RDAMPER" : "BDAMPER", 1);
        assert_cards(&scene, "RSERIES", 0);
        scene.drive.leakage_resistance = 1e11;
        assert_cards(&scene, "RLEAK", 1);
        assert_cards(&scene, "CCHARGE", 0);
        scene.drive.series_resistance = 1e6;
        assert_cards(&scene, "RSERIES", 1);
        assert_cards(&scene, "CCHARGE", 1);
    }
}

static void every_number_of_an_expression_is_a_parameter(void **state)
{
    (void)state;
    dea_scene scene = protocol("coverage");
    scene.material.density = 1080.0;
    scene.material.retardation = 1e-4;
    scene.drive.series_resistance = 1e6;
    add_branches(&scene);
    char *netlist = netlist_of(&scene);
    assert_true(netlist[0] == '*' && netlist[1] == ' ');
    assert_string_equal(netlist + strlen(netlist) - 6, "\n.end\n");
    for (char *line = strtok(netlist, "\n"); line; line = strtok(NULL, "\n")) {
        assert_true(strchr("*.", line[0]) || isupper((unsigned char)line[0]));
        for (const char *at = line; *at && line[0] != '*'; at++) {
            assert_false(line[0] == 'B' && *at == '.'); /* a fraction written out */
        }
    }
    free(netlist);
}

static void both_edges_of_a_pulse_are_corners_of_the_source(void **state)
{
    (void)state;
    const dea_scene scene = protocol("lumped");
    char *netlist = netlist_of(&scene);
    assert_non_null(strstr(netlist, "VSOURCE film 0 pwl(0 0 5 0 5.000001 4500 15 4500 15.000001 0 25 0)\n"));
    free(netlist);
}

/* What a study gave: rows and summary, or rows of a response. */
typedef struct outcome {
    char *point; /* owned */
    size_t size;
    char log[300];
} outcome;

static dea_status take(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    outcome *o = user;
    (void)error;
    assert_int_equal(first, 0);
    assert_int_equal(count, 1);
    memcpy(o->point, points, o->size);
    return DEA_OK;
}

static void keep_log(void *user, const char *line)
{
    outcome *o = user;
    snprintf(o->log, sizeof o->log, "%s", line);
}

static outcome run(const dea_scene *scene, const char *engine)
{
    dea_error error = {0};
    outcome o = {.size = dea_layout_of(scene).point_size};
    o.point = malloc(o.size);
    assert_non_null(o.point);
    const dea_run_options options = {.jobs = 1, .points = take, .log = keep_log, .user = &o};
    if (dea_study_run(scene, dea_engine_find(engine), &options, &error) != DEA_OK) {
        fail_msg("%s: %s", engine, error.message);
    }
    return o;
}

static dea_sample sample_of(const outcome *o, size_t index)
{
    dea_sample sample;
    memcpy(&sample, o->point + index * sizeof sample, sizeof sample);
    return sample;
}

static dea_summary summary_of(const dea_scene *scene, const outcome *o)
{
    const dea_layout layout = dea_layout_of(scene);
    dea_summary summary;
    memcpy(&summary, dea_layout_summary(&layout, o->point), sizeof summary);
    return summary;
}

/* Largest difference of two runs over the peak, where both have numbers; NAN where their states differ. */
static double difference(const dea_scene *scene, const outcome *a, const outcome *b)
{
    double worst = 0.0;
    double peak = 0.0;
    for (size_t i = 0; i < dea_layout_of(scene).rows; i++) {
        const dea_sample x = sample_of(a, i);
        const dea_sample y = sample_of(b, i);
        if (x.state != y.state) {
            return (double)NAN;
        }
        worst = fmax(worst, isnan(y.displacement) ? 0.0 : fabs(x.displacement - y.displacement));
        peak = fmax(peak, isnan(y.displacement) ? 0.0 : fabs(y.displacement));
    }
    return peak > 0.0 ? worst / peak : 0.0;
}

static void check_run(const dea_scene *scene, const dea_scene *judged, const char *judge, double judge_error, int number)
{
    outcome answer = run(scene, "ngspice");
    outcome wanted = run(judged, judge);
    const dea_summary summary = summary_of(scene, &answer);
    const double error = difference(scene, &answer, &wanted);
    const dea_state last = sample_of(&wanted, dea_layout_of(scene).rows - 1).state;
    const bool judged_whole = last != DEA_STATE_FAILED;
    const bool balanced = summary.residual <= 10.0 * scene->accuracy || last == DEA_STATE_PULL_IN;
    const bool good = error <= scene->accuracy + judge_error && error <= summary.error + judge_error && balanced;
    if (judged_whole && !good) {
        print_error("scene %d, %s against %s: error %.3g, bar %.3g, wanted %.3g, energies %.3g, %s\n", number,
                    scene->models[0]->name, judge, error, summary.error, scene->accuracy, summary.residual, answer.log);
        fail();
    }
    free(answer.point);
    free(wanted.point);
}

static void linear_films_move_as_their_closed_form_says(void **state)
{
    (void)state;
    int checked = 0;
    for (int i = 0; i < 120; i++) {
        uint64_t seed = 4000037u * (uint64_t)(i + 1);
        dea_scene scene;
        random_transient(&seed, &scene);
        scene.accuracy = random_decades(&seed, 1e-6, 1e-3);
        dea_scene exact = scene;
        exact.accuracy = 1e-10;
        if (scene.models[0]->linear && !dea_engine_refuses(dea_engine_find("direct"), &exact, scene.models[0])) {
            check_run(&scene, &exact, "direct", 1e-9, i);
            checked++;
        }
    }
    assert_true(checked >= 15);
}

static void films_of_every_model_move_as_by_another_integrator(void **state)
{
    (void)state;
    for (int i = 0; i < 24; i++) {
        uint64_t seed = 5000011u * (uint64_t)(i + 1);
        dea_scene scene;
        random_transient(&seed, &scene);
        scene.accuracy = random_decades(&seed, 1e-5, 1e-3);
        dea_scene finer = scene;
        finer.accuracy = 1e-2 * scene.accuracy;
        check_run(&scene, &finer, "ida", finer.accuracy, i);
    }
}

/* K (1 + c) u - c K z = F, z' = (u - z)/tau: u = F/K (1 - c/(1 + c) exp(-t/(tau (1 + c)))). */
static void creep_is_right_over_a_day(void **state)
{
    (void)state;
    dea_scene scene = protocol("lumped");
    scene.material.prony_count = 1;
    scene.material.prony[0] = (dea_prony){0.3, 2e4};
    scene.transient = (dea_transient){.until = 1e5, .every = 100.0};
    scene.drive.waveform.step = (dea_step){0.0, (double)NAN, 3000.0, 0.0};
    const double c = 0.3 / 0.7;
    dea_scene rest = scene;
    rest.drive.voltage = 3000.0;
    const double last = solve_direct(&rest, "lumped").displacement;
    outcome o = run(&scene, "ngspice");
    for (size_t i = 0; i <= 1000; i++) {
        const dea_sample s = sample_of(&o, i);
        assert_near(s.displacement, last * (1.0 - c / (1.0 + c) * exp(-s.time / (2e4 * (1.0 + c)))), 1e-6 * last);
    }
    free(o.point);
}

static void film_that_starts_in_its_equilibrium_stays_there(void **state)
{
    (void)state;
    dea_scene scene = protocol("coverage");
    add_branches(&scene);
    scene.material.density = 1080.0;
    scene.transient.from_bias = true;
    scene.drive.waveform.step = (dea_step){0.0, (double)NAN, 4500.0, 0.0};
    dea_scene rest = scene;
    rest.drive.voltage = 4500.0;
    const double u = solve_direct(&rest, "coverage").displacement;
    outcome o = run(&scene, "ngspice");
    for (size_t i = 0; i < dea_layout_of(&scene).rows; i++) {
        assert_near(sample_of(&o, i).displacement, u, 1e-9 * u);
    }
    free(o.point);
}

static void rows_before_a_pull_in_are_kept(void **state)
{
    (void)state;
    dea_scene scene = protocol("coverage");
    scene.actuator.coverage = 0.1;
    scene.material.constants[1] = scene.material.constants[2] = 0.0; /* a neo-Hookean film folds */
    const double most = pull_in_voltage(&scene, "coverage");
    double times[] = {0.0, 1.0};
    double voltages[] = {0.0, 2.0 * most};
    scene.drive.voltage = 2.0 * most;
    assert_int_equal(solve_direct(&scene, "coverage").state, DEA_STATE_PULL_IN);
    scene.drive.voltage = (double)NAN;
    scene.drive.waveform =
        (dea_waveform){.kind = DEA_WAVE_POINTS, .times = times, .voltages = voltages, .point_count = 2, .period = (double)NAN};
    scene.transient = (dea_transient){.until = 1.0, .every = 0.01};
    scene.accuracy = 1e-3;
    outcome o = run(&scene, "ngspice");
    for (size_t i = 0; i <= 100; i++) {
        const dea_sample s = sample_of(&o, i);
        dea_scene still = scene;
        still.drive.voltage = s.voltage;
        const dea_row row = solve_direct(&still, "coverage");
        if (fabs(s.voltage - most) > 0.02 * most) {
            assert_int_equal(s.state, row.state);
        }
        if (s.voltage < 0.95 * most) {
            assert_near(s.displacement, row.displacement, 1e-3 * fabs(row.displacement) + 1e-12);
        }
    }
    assert_int_equal(sample_of(&o, 100).state, DEA_STATE_PULL_IN);
    free(o.point);
}

/* Nothing holds the velocity of a film without mass and damper; steps of the first moment are far shorter than any of its times.
 */
static void film_without_mass_and_damper_rests_behind_its_resistance(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        dea_scene scene = protocol("coverage");
        scene.actuator.kind = i == 0 ? DEA_LENS : DEA_DOT;
        scene.actuator.frame_radius = 0.35e-3;
        scene.actuator.coverage = 0.958;
        scene.drive.waveform =
            (dea_waveform){.kind = DEA_WAVE_STEP, .step = {.off = (double)NAN, .voltage = 675.0}, .period = (double)NAN};
        scene.drive.series_resistance = 1e11;
        scene.material.prony_count = 1;
        scene.material.prony[0] = (dea_prony){.g = 0.45, .tau = 0.8};
        scene.transient = (dea_transient){.until = 26.0, .every = 2.6, .from_bias = true};
        scene.accuracy = 1e-4;
        check_run(&scene, &scene, "ida", scene.accuracy, i);
        outcome o = run(&scene, "ngspice");
        assert_int_equal(sample_of(&o, dea_layout_of(&scene).rows - 1).state, DEA_STATE_OK);
        free(o.point);
    }
}

/* A mass of microscopic size behind a strong damper settles in 1e-13 s. */
static void mass_that_a_damper_outweighs_costs_nothing(void **state)
{
    (void)state;
    dea_scene scene = protocol("lumped");
    scene.actuator.frame_radius = 1.4e-4;
    scene.material.density = 1180.0;
    scene.material.retardation = 0.004;
    scene.drive.waveform = (dea_waveform){
        .kind = DEA_WAVE_STEP, .step = {.on = 0.01, .off = 0.05, .voltage = 4500.0, .rise = 1e-7}, .period = (double)NAN};
    scene.transient = (dea_transient){.until = 0.1, .every = 1e-3};
    scene.accuracy = 1e-4;
    check_run(&scene, &scene, "direct", 0.0, 0);
    outcome o = run(&scene, "ngspice");
    assert_int_equal(sample_of(&o, 100).state, DEA_STATE_OK);
    assert_true(isnan(summary_of(&scene, &o).resonance)); /* overdamped */
    free(o.point);
}

static void transients_beyond_its_rule_are_refused_by_name(void **state)
{
    (void)state;
    dea_scene scene = protocol("lumped");
    scene.accuracy = 0.9e-6;
    const char *why = dea_engine_refuses(dea_engine_find("ngspice"), &scene, scene.models[0]);
    assert_non_null(why);
    assert_non_null(strstr(why, "trapezoidal"));
    scene.accuracy = 1e-6;
    assert_null(dea_engine_refuses(dea_engine_find("ngspice"), &scene, scene.models[0]));
}

static void ring_too_long_for_its_accuracy_fails_and_says_so(void **state)
{
    (void)state;
    dea_scene scene = protocol("lumped");
    scene.material.density = 1080.0; /* nothing damps 600 Hz over an hour */
    scene.transient = (dea_transient){.until = 3600.0, .every = 1.0};
    outcome o = run(&scene, "ngspice");
    assert_int_equal(sample_of(&o, 3600).state, DEA_STATE_FAILED);
    assert_non_null(strstr(o.log, "loses a phase"));
    free(o.point);
}

/* The library lives in a process of its own: what a child finds is told by its exit status. */
typedef struct child_route {
    dea_scene scene;
    dea_dynamics dynamics, slow;
    dea_mobility mobility;
    dea_signal signal;
    dea_pieces pieces;
    dea_route route;
} child_route;

static void lay_route(child_route *c)
{
    dea_error error = {0};
    c->scene.accuracy = 1e-6;
    const bool ready = dea_dynamics_open(&c->scene, c->scene.models[0], &c->dynamics, &error) == DEA_OK &&
                       dea_mobility_open(&c->scene, &c->dynamics, &c->mobility, &error) == DEA_OK &&
                       dea_signal_open(&c->scene, &c->signal, &error) == DEA_OK;
    c->slow = c->dynamics;
    c->slow.mass = c->slow.retardation = 0.0;
    const dea_pace pace = dea_pace_of(&c->dynamics, 0.0, 0.0);
    c->route = (dea_route){.scene = &c->scene,
                           .dynamics = &c->dynamics,
                           .slow = &c->slow,
                           .mobility = &c->mobility,
                           .signal = &c->signal,
                           .pieces = &c->pieces,
                           .samples = dea_layout_of(&c->scene).rows,
                           .scale = 1e-3,
                           .omega = pace.omega};
    if (!ready || dea_pieces_cut(&c->signal, &pace, 1e-6, 0.0, true, &c->pieces, &error) != DEA_OK ||
        dea_ngspice_open(&c->route.library, &error) != DEA_OK) {
        _exit(100);
    }
}

static dea_track track(const child_route *c, double fineness)
{
    dea_error error = {0};
    dea_track t;
    if (dea_track_run(&c->route, fineness, &t, &error) != DEA_OK || t.end != DEA_STATE_OK) {
        fprintf(stderr, "%s\n", error.message);
        _exit(101);
    }
    return t;
}

static double track_difference(const child_route *c, const dea_track *a, const dea_track *b)
{
    double worst = 0.0;
    double peak = 0.0;
    for (size_t i = 0; i < c->route.samples; i++) {
        worst = fmax(worst, fabs(a->points[i].u - b->points[i].u));
        peak = fmax(peak, fabs(b->points[i].u));
    }
    return worst / peak;
}

static void run_in_child(void (*work)(void))
{
    int status;
    const pid_t pid = fork();
    assert_true(pid >= 0);
    if (pid == 0) {
        work();
        _exit(0);
    }
    assert_int_equal(waitpid(pid, &status, 0), pid);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 0);
}

/* A fifth of a second of the ring after switch-on. */
static child_route ringing_route(void)
{
    child_route c = {.scene = protocol("lumped")};
    c.scene.material.density = 1080.0;
    add_branches(&c.scene);
    c.scene.transient = (dea_transient){.until = 0.2, .every = 1e-3};
    c.scene.drive.waveform.step = (dea_step){0.01, (double)NAN, 4500.0, 1e-6};
    return c;
}

static void measure_order(void)
{
    child_route c = ringing_route();
    lay_route(&c);
    const dea_track finest = track(&c, 1.0 / 128.0);
    const dea_track coarse = track(&c, 1.0 / 8.0);
    const dea_track fine = track(&c, 1.0 / 32.0);
    const double order = log(track_difference(&c, &coarse, &finest) / track_difference(&c, &fine, &finest)) / log(4.0);
    if (!(order > 1.8 && order < 2.5)) {
        fprintf(stderr, "order %g\n", order);
        _exit(1);
    }
}

static void error_falls_with_the_square_of_the_step(void **state)
{
    (void)state;
    run_in_child(measure_order);
}

/* The same steps in one netlist and in many. */
static void compare_pieces(void)
{
    child_route c = ringing_route();
    lay_route(&c);
    const double step = 1.0 / 16.0;
    const dea_track whole = track(&c, step);
    dea_piece cut[400];
    size_t count = 0;
    for (size_t i = 0; i < c.pieces.count; i++) {
        const dea_piece *p = &c.pieces.pieces[i];
        const int parts = p->rings && p->to - p->from > 0.01 ? 20 : 1;
        for (int k = 0; k < parts; k++) {
            cut[count] = *p;
            cut[count].from = p->from + (p->to - p->from) * k / parts;
            cut[count].to = k + 1 == parts ? p->to : p->from + (p->to - p->from) * (k + 1) / parts;
            count++;
        }
    }
    dea_pieces many = {.pieces = cut, .count = count};
    c.route.pieces = &many;
    const dea_track parts = track(&c, step);
    const double change = track_difference(&c, &parts, &whole);
    if (count < 20 || !(change < 1e-5)) {
        fprintf(stderr, "%zu pieces change the run by %g\n", count, change);
        _exit(1);
    }
}

static void run_in_pieces_is_the_run_in_one(void **state)
{
    (void)state;
    run_in_child(compare_pieces);
}

/* Pulses far faster than the film: masses fit the steps that the library takes between their corners, not those that the film would
 * allow, by which the first run was off by 2.4e-2. */
static void compare_pulses(void)
{
    static const char text[] =
        "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
        "material: {base: elastosil-2030, retardation: 100 us}\n"
        "drive: {waveform: {pulse: {voltage: 4 kV, frequency: 5 kHz, duty: 0.5, rise: 2 us}}}\n"
        "model: ring\nstudy: {transient: {until: 15 ms, every: 0.5 ms}}\n";
    dea_error error = {0};
    child_route c;
    if (dea_scene_parse(text, strlen(text), "pulses", ".", NULL, 0, NULL, &c.scene, &error) != DEA_OK) {
        _exit(100);
    }
    lay_route(&c);
    const dea_track coarse = track(&c, 1.0);
    const dea_track fine = track(&c, 0.25);
    const double change = track_difference(&c, &coarse, &fine);
    if (!(change < 2e-3)) {
        fprintf(stderr, "finer steps between pulses change the run by %g\n", change);
        _exit(1);
    }
}

static void masses_fit_the_steps_between_pulses(void **state)
{
    (void)state;
    run_in_child(compare_pulses);
}

/* A run that may take half of its work ends on the way, by count: twice at the same step. */
static void exhaust(void)
{
    child_route c = ringing_route();
    dea_error error = {0};
    lay_route(&c);
    const dea_track whole = track(&c, 0.25);
    dea_track ends[2];
    c.route.most = 0.5 * dea_track_work(&c.route, whole.steps, whole.netlists);
    for (int i = 0; i < 2; i++) {
        if (dea_track_run(&c.route, 0.25, &ends[i], &error) != DEA_OK) {
            _exit(101);
        }
    }
    const bool early = ends[0].exhausted && ends[0].end == DEA_STATE_FAILED && ends[0].steps < whole.steps;
    if (whole.exhausted || !early || ends[0].steps != ends[1].steps || ends[0].reached != ends[1].reached) {
        fprintf(stderr, "%g and %g of %g steps\n", ends[0].steps, ends[1].steps, whole.steps);
        _exit(1);
    }
}

static void run_without_end_stops_where_its_work_is_done(void **state)
{
    (void)state;
    run_in_child(exhaust);
}

static double angle_between(double a, double b)
{
    return fabs(remainder(a - b, 360.0));
}

static void frequency_responses_are_those_of_the_closed_form(void **state)
{
    (void)state;
    for (int i = 0; i < 30; i++) {
        uint64_t seed = 7000003u * (uint64_t)(i + 1);
        dea_scene scene;
        random_transient(&seed, &scene);
        scene.study = DEA_STUDY_AC;
        scene.accuracy = 1e-9;
        scene.ac = (dea_ac){.from = 0.01 / scene.transient.until,
                            .to = 1000.3 / scene.transient.until,
                            .points_per_decade = 7,
                            .bias = random_between(&seed, 0.1, 0.9) * pull_in_voltage(&scene, scene.models[0]->name)};
        outcome a = run(&scene, "ngspice");
        outcome b = run(&scene, "direct");
        for (size_t k = 0; k < dea_layout_of(&scene).rows; k++) {
            dea_response x, y;
            memcpy(&x, a.point + k * sizeof x, sizeof x);
            memcpy(&y, b.point + k * sizeof y, sizeof y);
            assert_int_equal(x.state, y.state);
            assert_true(x.frequency == y.frequency);
            if (x.state != DEA_STATE_PULL_IN) {
                assert_relative(x.displacement, y.displacement, 1e-9);
                assert_relative(x.impedance, y.impedance, 1e-9);
                assert_true(angle_between(x.displacement_phase, y.displacement_phase) < 1e-7);
                assert_true(angle_between(x.impedance_phase, y.impedance_phase) < 1e-7);
            }
        }
        free(a.point);
        free(b.point);
    }
}

/* Steps of a decade that rounding alone keeps from being whole. */
static void no_frequency_is_lost_to_rounding(void **state)
{
    (void)state;
    dea_scene scene = protocol("lumped");
    scene.study = DEA_STUDY_AC;
    for (int i = 0; i < 60; i++) {
        const double from = 1748.7993 * (1.0 + 0.0137 * i);
        scene.ac = (dea_ac){.from = from, .to = 58.83 * from, .points_per_decade = 7, .bias = 1000.0};
        outcome o = run(&scene, "ngspice");
        const dea_layout layout = dea_layout_of(&scene);
        assert_int_equal(dea_layout_state(&layout, o.point), DEA_STATE_OK);
        free(o.point);
    }
}

/* A capacitor's phase of 1e-8 rad short of a right angle: the current is no difference of the voltages around the resistance. */
static void a_large_resistance_keeps_the_phase_of_the_impedance(void **state)
{
    (void)state;
    dea_scene scene = protocol("coverage");
    scene.material.prony_count = 1;
    scene.material.prony[0] = (dea_prony){0.2, 4e-6};
    scene.drive.series_resistance = 1e12;
    scene.study = DEA_STUDY_AC;
    scene.accuracy = 1e-9;
    scene.ac = (dea_ac){.from = 1e-8, .to = 1e-3, .points_per_decade = 3, .bias = 3000.0};
    outcome a = run(&scene, "ngspice");
    outcome b = run(&scene, "direct");
    for (size_t k = 0; k < dea_layout_of(&scene).rows; k++) {
        dea_response x, y;
        memcpy(&x, a.point + k * sizeof x, sizeof x);
        memcpy(&y, b.point + k * sizeof y, sizeof y);
        assert_relative(x.impedance, y.impedance, 1e-9);
        assert_true(angle_between(x.impedance_phase, y.impedance_phase) < 1e-9 * 180.0 / DEA_PI);
    }
    free(a.point);
    free(b.point);
}

/* A step past the fold onto a film that stiffens beyond it: the damper carries it through where nothing holds it. */
static void a_damped_film_snaps_through(void **state)
{
    (void)state;
    dea_scene scene = protocol("coverage");
    scene.actuator = paper_scene(DEA_DOT, 1.411, 0.326, 0.0).actuator;
    scene.actuator.frame_radius = 0.0244;
    scene.actuator.film_thickness = 7.37e-5;
    scene.material.constants[0] = 196043.5;
    scene.material.constants[1] = -2530.5;
    scene.material.constants[2] = 4548.2;
    scene.material.permittivity = 5.7475;
    scene.material.retardation = 2.2e-5;
    scene.material.prony_count = 0;
    scene.material.density = (double)NAN;
    scene.drive.waveform.step = (dea_step){4.7e-4, (double)NAN, 12651.5, 0.0};
    scene.transient = (dea_transient){.until = 3.26e-3, .every = 1.36e-4};
    scene.accuracy = 1e-4;
    dea_scene finer = scene;
    finer.accuracy = 1e-6;
    check_run(&scene, &finer, "ida", finer.accuracy, 0);
}

/* Behind a resistance, right after a jump, far below what the film would reach at rest: where ngspice's own iteration ends early,
 * all runs do so alike, and no comparison of them tells. */
static void a_small_part_of_the_way_keeps_its_digits(void **state)
{
    (void)state;
    dea_scene scene = protocol("lumped");
    scene.actuator = paper_scene(DEA_DOT, 1.2513399201379898, 0.94469603318627193, 0.0).actuator;
    scene.actuator.frame_radius = 0.0013429273601450787;
    scene.actuator.film_thickness = 6.7743024175892928e-05;
    scene.material.constants[0] = 374791.09446750127;
    scene.material.constants[1] = 0.0;
    scene.material.constants[2] = 4121.045749163899;
    scene.material.permittivity = 8.8080213009698287;
    scene.material.permittivity_per_stretch = -0.11287801925126462;
    scene.material.density = 924.82051720053721;
    scene.material.prony_count = 3;
    scene.material.prony[0] = (dea_prony){0.23776908025610202, 3.4860184950993141e-05};
    scene.material.prony[1] = (dea_prony){0.10961293152283363, 3.5995711811726036e-07};
    scene.material.prony[2] = (dea_prony){0.18645877169803626, 0.69908324921626874};
    scene.drive.series_resistance = 386822.73002244672;
    scene.drive.waveform.step = (dea_step){3.3634255339461662e-05, 0.00013444237886345062, 19283.049058818815, 0.0};
    scene.transient = (dea_transient){.until = 0.00034796175066229636, .every = 1.1598725022076545e-05, .from_bias = true};
    scene.accuracy = 1e-6;
    dea_scene finer = scene;
    finer.accuracy = 1e-8;
    check_run(&scene, &finer, "ida", finer.accuracy, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(network_has_the_elements_of_the_scene_and_no_other),
        cmocka_unit_test(every_number_of_an_expression_is_a_parameter),
        cmocka_unit_test(both_edges_of_a_pulse_are_corners_of_the_source),
        cmocka_unit_test(creep_is_right_over_a_day),
        cmocka_unit_test(film_that_starts_in_its_equilibrium_stays_there),
        cmocka_unit_test(rows_before_a_pull_in_are_kept),
        cmocka_unit_test(film_without_mass_and_damper_rests_behind_its_resistance),
        cmocka_unit_test(mass_that_a_damper_outweighs_costs_nothing),
        cmocka_unit_test(transients_beyond_its_rule_are_refused_by_name),
        cmocka_unit_test(ring_too_long_for_its_accuracy_fails_and_says_so),
        cmocka_unit_test(error_falls_with_the_square_of_the_step),
        cmocka_unit_test(run_in_pieces_is_the_run_in_one),
        cmocka_unit_test(masses_fit_the_steps_between_pulses),
        cmocka_unit_test(run_without_end_stops_where_its_work_is_done),
        cmocka_unit_test(frequency_responses_are_those_of_the_closed_form),
        cmocka_unit_test(no_frequency_is_lost_to_rounding),
        cmocka_unit_test(a_large_resistance_keeps_the_phase_of_the_impedance),
        cmocka_unit_test(a_damped_film_snaps_through),
        cmocka_unit_test(a_small_part_of_the_way_keeps_its_digits),
        cmocka_unit_test(linear_films_move_as_their_closed_form_says),
        cmocka_unit_test(films_of_every_model_move_as_by_another_integrator),
    };
    return cmocka_run_group_tests_name("mobility", tests, NULL, NULL);
}
