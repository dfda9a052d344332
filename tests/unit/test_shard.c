/* Studies in shards: the parts of a study are its result again, and what does not fit is refused. */
#include "child_program.h"
#include "scenes.h"

#include "engine/cut.h"
#include "journal/journal.h"
#include "scene/keys.h"

/* Two models, two axes, 2 x 150 points in blocks of several sizes; the largest electrode does not fit its frame. */
static const char sweep_text[] =
    "title: swept\n"
    "actuator: {kind: dot, frame_radius: 30 mm, electrode_radius: 15 mm, film_thickness: 100 um, prestretch: 1.2}\n"
    "material: elastosil-2030\n"
    "drive: {voltage: 3 kV}\n"
    "model: [lumped, coverage]\n"
    "study: {sweep: {prestretch: [1.1, 1.2, 1.3], electrode_radius: {from: 5 mm, to: 29 mm, points: 500}}}\n";
static const char step_text[] =
    "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
    "material: {base: elastosil-2030, density: 1080 kg/m^3, retardation: 1 ms}\n"
    "drive: {waveform: {step: {on: 10 ms, off: 60 ms, voltage: 3 kV, rise: 0 s}}}\n"
    "model: lumped\n"
    "study: {transient: {until: 100 ms, every: 1 ms, average: {from: 40 ms, to: 60 ms}}, over: {coverage: [0.2, 0.5, 0.8], "
    "prestretch: [1.1, 1.3]}}\n";
static const char response_text[] =
    "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
    "material: {base: elastosil-2030, retardation: 0.1 ms}\n"
    "drive: {voltage: 3 kV}\n"
    "model: [lumped, lame]\n"
    "study: {ac: {from: 1 Hz, to: 10 kHz, points_per_decade: 5}, over: {coverage: [0.2, 0.5, 0.8]}}\n";
/* A quarter of its points have an electrode larger than the frame. */
static const char failing_text[] =
    "actuator: {kind: dot, frame_radius: 30 mm, electrode_radius: 15 mm, film_thickness: 100 um, prestretch: 1.2}\n"
    "material: elastosil-2030\n"
    "drive: {voltage: 3 kV}\n"
    "model: lumped\n"
    "study: {sweep: {frame_radius: [10 mm, 20 mm], electrode_radius: {from: 5 mm, to: 15 mm, points: 500}}}\n";

static void run_shards(const char *scene, const char *engine, size_t count)
{
    for (size_t i = 1; i <= count; i++) {
        char shard[32], part[32];
        snprintf(shard, sizeof shard, "%zu/%zu", i, count);
        snprintf(part, sizeof part, "part-%zu.dea", i);
        RUN("run", scene, "--engine", engine, "--shard", shard, "-o", part, "-j", i % 2 ? "1" : "2");
        assert_status(0);
        assert_false(file_exists("part-1.dea.journal"));
    }
}

static void merge_is_the_whole_run(const char *scene, const char *engine)
{
    static const char *const formats[] = {"csv", "nc", "raw"};
    static const char *const orders[][8] = {
        {"part-1.dea"},
        {"part-2.dea", "part-1.dea"},
        {"part-3.dea", "part-7.dea", "part-1.dea", "part-6.dea", "part-2.dea", "part-5.dea", "part-4.dea"}};
    static const size_t counts[] = {1, 2, 7};
    char averages[CHILD_TEXT];
    for (size_t i = 0; i < 3; i++) {
        char whole[32];
        snprintf(whole, sizeof whole, "whole.%s", formats[i]);
        RUN("run", scene, "--engine", engine, "-o", whole);
        assert_status(0);
        memcpy(averages, child_out, sizeof averages);
    }
    for (size_t k = 0; k < 3; k++) {
        run_shards(scene, engine, counts[k]);
        for (size_t i = 0; i < 3; i++) {
            char whole[32], merged[32];
            snprintf(whole, sizeof whole, "whole.%s", formats[i]);
            snprintf(merged, sizeof merged, "merged.%s", formats[i]);
            const char *const *o = orders[k];
            child_wait(child_start(0, (const char *const[]){"merge", scene, "--engine", engine, "-o", merged, o[0], o[1], o[2],
                                                            o[3], o[4], o[5], o[6], NULL}));
            assert_status(0);
            assert_string_equal(child_out, averages);
            assert_true(same_bytes(whole, merged));
        }
    }
}

static void merged_sweep_is_the_whole_run(void **state)
{
    (void)state;
    file_write("sweep.yaml", sweep_text, sizeof sweep_text - 1);
    merge_is_the_whole_run("sweep.yaml", "ngspice");
    merge_is_the_whole_run("sweep.yaml", "direct");
}

static void merged_transients_are_the_whole_run(void **state)
{
    (void)state;
    file_write("step.yaml", step_text, sizeof step_text - 1);
    merge_is_the_whole_run("step.yaml", "direct");
    merge_is_the_whole_run("step.yaml", "ida");
    assert_non_null(strstr(child_out, "coverage,prestretch,from_s,to_s,strain,displacement_m,least_m,largest_m,peak_to_peak_m\n"));
}

static void merged_responses_are_the_whole_run(void **state)
{
    (void)state;
    file_write("response.yaml", response_text, sizeof response_text - 1);
    merge_is_the_whole_run("response.yaml", "direct");
}

static void jobs_change_no_bit_of_a_result(void **state)
{
    (void)state;
    static const char *const engines[] = {"direct", "ngspice", "ida"};
    static const char *const jobs[] = {"1", "2", "5"};
    static const char *const names[] = {"1.csv", "2.csv", "5.csv"};
    file_write("sweep.yaml", sweep_text, sizeof sweep_text - 1);
    file_write("step.yaml", step_text, sizeof step_text - 1);
    file_write("response.yaml", response_text, sizeof response_text - 1);
    static const char *const scenes[] = {"sweep.yaml", "step.yaml", "response.yaml"};
    for (size_t i = 0; i < 9; i++) {
        if (i / 3 == 2 && i % 3 == 2) {
            continue; /* IDA has no frequency domain */
        }
        for (size_t k = 0; k < 3; k++) {
            RUN("run", scenes[i / 3], "--engine", engines[i % 3], "-j", jobs[k], "-q", "-o", names[k]);
            assert_status(0);
        }
        assert_true(same_bytes("1.csv", "2.csv"));
        assert_true(same_bytes("1.csv", "5.csv"));
    }
}

static void failed_rows_fail_the_shard_and_the_merge(void **state)
{
    (void)state;
    file_write("failing.yaml", failing_text, sizeof failing_text - 1);
    RUN("run", "failing.yaml", "--engine", "direct", "-o", "whole.csv");
    assert_status(1);
    assert_says("250 points were not solved");
    RUN("run", "failing.yaml", "--engine", "direct", "--shard", "1/1", "-o", "part-1.dea");
    assert_status(1);
    assert_says("250 points were not solved");
    RUN("merge", "failing.yaml", "--engine", "direct", "part-1.dea", "-o", "merged.csv");
    assert_status(1);
    assert_says("250 points were not solved");
    assert_true(same_bytes("whole.csv", "merged.csv"));
}

static void refused(const char *says, const char *const *words)
{
    remove("merged.csv");
    child_wait(child_start(0, words));
    assert_status(2);
    assert_says(says);
    assert_false(file_exists("merged.csv"));
}

#define MERGE "merge", "sweep.yaml", "-o", "merged.csv", "--engine", "ngspice"

static void gaps_and_overlaps_are_named(void **state)
{
    (void)state;
    file_write("sweep.yaml", sweep_text, sizeof sweep_text - 1);
    run_shards("sweep.yaml", "ngspice", 2);
    assert_int_equal(rename("part-1.dea", "half.dea"), 0);
    run_shards("sweep.yaml", "ngspice", 7);
    refused("no part is shard 2, 4-6 of 7; shard 2 has points ", WORDS(MERGE, "part-1.dea", "part-7.dea", "part-3.dea"));
    refused("no part is shard 7 of 7; ",
            WORDS(MERGE, "part-1.dea", "part-2.dea", "part-3.dea", "part-4.dea", "part-5.dea", "part-6.dea"));
    refused("part-3.dea and part-3.dea are both shard 3/7: points ", WORDS(MERGE, "part-3.dea", "part-1.dea", "part-3.dea"));
    refused("they are of different divisions", WORDS(MERGE, "part-1.dea", "half.dea"));
    refused("part-9.dea", WORDS(MERGE, "part-9.dea"));
    refused("needs a scene and its parts", WORDS("merge", "sweep.yaml"));
    refused("part-1.dea would overwrite part-1.dea, an input", WORDS("merge", "sweep.yaml", "part-1.dea", "-o", "part-1.dea"));
    assert_true(file_exists("part-1.dea"));
}

static void foreign_parts_are_named_with_their_difference(void **state)
{
    (void)state;
    file_write("sweep.yaml", sweep_text, sizeof sweep_text - 1);
    run_shards("sweep.yaml", "ngspice", 1);
    refused("part-1.dea belongs to another study: drive.voltage is 3000 there and 2000 here",
            WORDS(MERGE, "--set", "voltage=2 kV", "part-1.dea"));
    refused("model is lumped,coverage there and lumped here", WORDS(MERGE, "--model", "lumped", "part-1.dea"));
    refused("accuracy is 1e-06 there and 1e-05 here", WORDS(MERGE, "--set", "accuracy=1e-5", "part-1.dea"));
    refused("engine is ngspice there and direct here",
            WORDS("merge", "sweep.yaml", "-o", "merged.csv", "--engine", "direct", "part-1.dea"));
    refused("axis actuator.prestretch is 3 values",
            WORDS(MERGE, "--set", "study.sweep.prestretch=[1.1, 1.21, 1.3]", "part-1.dea"));
    refused("no part of a study", WORDS(MERGE, "sweep.yaml"));
    refused("no regular file", WORDS(MERGE, "."));
}

/* A part of three blocks in memory, and the study that it is of. */
static dea_scene scene;
static dea_axis axis;
static double values[2500];
static dea_journal_study study;
static char *part;
static size_t part_size;

static void prepare_part(void)
{
    dea_error error = {0};
    scene = paper_scene(DEA_DOT, 1.2, 0.5, 3000.0);
    scene.models[0] = dea_model_find("lumped");
    for (size_t i = 0; i < 2500; i++) {
        values[i] = 0.1 + 0.0003 * (double)i;
    }
    add_axis(&scene, &axis, &scene.actuator.coverage, values, 2500);
    dea_journal *journal;
    assert_int_equal(dea_journal_study_make(&scene, dea_engine_find("direct"), &study, &error), DEA_OK);
    assert_int_equal(study.cut.blocks, 3);
    assert_int_equal(dea_journal_create(&study, (dea_shard){1, 1}, "whole.dea", &journal, &error), DEA_OK);
    for (size_t i = 3; i-- > 0;) { /* their order in the file does not matter */
        const dea_range range = dea_cut_range(&study.cut, i);
        dea_row rows[1024];
        for (size_t k = 0; k < range.count; k++) {
            const double number = (double)(range.first + k);
            rows[k] = (dea_row){number, -number, 2.0 * number, 0.5 * number, 3.0 * number, 4.0 * number, 5.0 * number, (double)NAN, 6.0 * number, 0.0, (dea_state)(k % DEA_STATE_COUNT)};
        }
        assert_int_equal(dea_journal_append(journal, range.place, rows, range.count, false, &error), DEA_OK);
        assert_int_equal(dea_journal_append(journal, range.place, rows, range.count, false, &error), DEA_ERROR_USAGE);
    }
    assert_int_equal(dea_journal_close(journal, DEA_JOURNAL_IS_PART, "whole.dea", &error), DEA_OK);
    part = file_read("whole.dea", &part_size);
}

static void forget_part(void)
{
    dea_journal_study_free(&study);
    free(part);
}

static dea_status count_points(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    size_t *next = user;
    const dea_row *rows = points;
    (void)error;
    assert_int_equal(first, *next);
    for (size_t i = 0; i < count; i++) {
        assert_true(rows[i].strain == (double)(first + i) && rows[i].field == 0.5 * (double)(first + i));
    }
    *next += count;
    return DEA_OK;
}

static dea_status merge_file(const char *name, size_t *points, dea_error *error)
{
    *points = 0;
    const dea_run_options options = {.points = count_points, .user = points};
    return dea_merge_parts(&study, &name, 1, &options, error);
}

static void a_journal_gives_back_what_it_took(void **state)
{
    (void)state;
    dea_error error = {0};
    size_t points;
    prepare_part();
    assert_int_equal(merge_file("whole.dea", &points, &error), DEA_OK);
    assert_int_equal(points, 2500);
    forget_part();
}

static void every_damaged_byte_is_found(void **state)
{
    (void)state;
    prepare_part();
    for (size_t i = 0; i < part_size; i += i < 4000 || i + 3000 > part_size ? 1 : 37) {
        dea_error error = {0};
        size_t points;
        part[i] = (char)(part[i] ^ (1 << i % 8));
        file_write("damaged.dea", part, part_size);
        part[i] = (char)(part[i] ^ (1 << i % 8));
        if (merge_file("damaged.dea", &points, &error) != DEA_ERROR_USAGE || !strstr(error.message, "damaged.dea")) {
            fail_msg("byte %zu: %s", i, error.message);
        }
    }
    forget_part();
}

static void every_cut_is_found(void **state)
{
    (void)state;
    prepare_part();
    for (size_t size = 0; size < part_size; size += size < 4000 || size + 3000 > part_size ? 1 : 37) {
        dea_error error = {0};
        size_t points;
        file_write("cut.dea", part, size);
        if (merge_file("cut.dea", &points, &error) != DEA_ERROR_USAGE || !strstr(error.message, "cut.dea")) {
            fail_msg("%zu bytes: %s", size, error.message);
        }
        assert_int_equal(points, 0);
    }
    forget_part();
}

static void the_other_byte_order_is_named(void **state)
{
    (void)state;
    dea_error error = {0};
    size_t points;
    prepare_part();
    for (size_t i = 0; i < 4; i++) { /* behind the magic of 16 bytes */
        const char byte = part[16 + i];
        part[16 + i] = part[23 - i];
        part[23 - i] = byte;
    }
    file_write("turned.dea", part, part_size);
    assert_int_equal(merge_file("turned.dea", &points, &error), DEA_ERROR_USAGE);
    assert_non_null(strstr(error.message, "turned.dea was written by a machine of the other byte order"));
    forget_part();
}

static void a_block_that_comes_twice_is_named(void **state)
{
    (void)state;
    dea_error error = {0};
    size_t points;
    prepare_part();
    const size_t record = 1024 * study.packed + 40, last = part_size - record; /* the last record is of the first block */
    char *doubled = malloc(part_size + record);
    assert_non_null(doubled);
    memcpy(doubled, part, part_size);
    memcpy(doubled + part_size, part + last, record);
    file_write("doubled.dea", doubled, part_size + record);
    assert_int_equal(merge_file("doubled.dea", &points, &error), DEA_ERROR_USAGE);
    assert_string_equal(error.message, "doubled.dea has points 0 to 1023 twice");
    file_write("short.dea", part, last);
    assert_int_equal(merge_file("short.dea", &points, &error), DEA_ERROR_USAGE);
    assert_string_equal(error.message, "short.dea is not complete: points 0 to 1023 are missing");
    free(doubled);
    forget_part();
}

static void take_line(void *user, const char *line)
{
    assert_int_equal(*(size_t *)user, 0); /* before any point */
    assert_string_equal(line, "lost.dea: the blocks of 1024 points lost their workers; run that shard again with --resume");
}

/* Lost points are not done: the block is wanted again, and its next record replaces them. */
static void lost_block_is_computed_again(void **state)
{
    (void)state;
    dea_error error = {0};
    dea_journal *journal;
    size_t points = 0;
    prepare_part();
    const dea_shard whole = {1, 1};
    static dea_row rows[3][1024];
    for (int round = 0; round < 2; round++) {
        assert_int_equal(dea_journal_open(&study, whole, "lost.dea", &journal, &error), DEA_OK);
        for (size_t i = 0; i < 3; i++) {
            const dea_range range = dea_cut_range(&study.cut, i);
            assert_true(dea_journal_wants(journal, i) == (round == 0 || i == 1));
            for (size_t k = 0; k < range.count; k++) {
                rows[i][k] = (dea_row){.strain = (double)(range.first + k), .field = 0.5 * (double)(range.first + k)};
            }
            if (round == 0 || i == 1) {
                assert_int_equal(dea_journal_append(journal, range.place, rows[i], range.count, round == 0 && i == 1, &error),
                                 DEA_OK);
            }
        }
        assert_int_equal(dea_journal_tell(journal).lost, round == 0 ? 1024 : 0);
        assert_int_equal(dea_journal_tell(journal).points, round == 0 ? 2500 - 1024 : 2500);
        assert_int_equal(dea_journal_close(journal, DEA_JOURNAL_STAYS, NULL, &error), DEA_OK);
        const dea_run_options options = {.points = count_points, .log = round == 0 ? take_line : NULL, .user = &points};
        const char *name = "lost.dea";
        points = 0;
        assert_int_equal(dea_merge_parts(&study, &name, 1, &options, &error), DEA_OK);
        assert_int_equal(points, 2500);
    }
    forget_part();
}

static void every_scalar_of_a_scene_counts(void **state)
{
    (void)state;
    const dea_engine *engine = dea_engine_find("direct");
    char *before, *after;
    size_t counted = 0;
    scene = paper_scene(DEA_LENS, 1.2, 0.5, 3000.0);
    scene.models[0] = dea_model_find("lumped");
    scene.electrode.law = dea_law_find("gent"); /* of more constants than that of the film */
    scene.material.law = dea_law_find("neo_hookean");
    assert_int_equal(dea_identity_write(&scene, engine, &before, NULL), DEA_OK);
    dea_key at;
    for (size_t i = 0; dea_key_at(i, &at); i++) {
        const dea_key *key = &at;
        const bool foreign = key->law && key->law != (strncmp(key->path, "electrode.", 10) ? scene.material.law : scene.electrode.law);
        if (key->offset == DEA_KEY_NOWHERE || key->stride > 0 || foreign || (key->kinds & DEA_KEY_LENS) == 0) {
            continue;
        }
        double *place = (double *)(void *)((char *)&scene + key->offset), value = *place;
        *place = isnan(value) ? 1.0 : nextafter(value, INFINITY);
        assert_int_equal(dea_identity_write(&scene, engine, &after, NULL), DEA_OK);
        if (strcmp(before, after) == 0) {
            fail_msg("%s does not count", key->path);
        }
        free(after);
        *place = value;
        counted++;
    }
    assert_true(counted > 30);
    free(before);
}

/* Changes scene number @p number; false past the last. */
static bool change(dea_scene *changed, size_t number)
{
    static double other[2] = {0.1, 0.2};
    switch (number) {
    case 0:
        return changed->actuator.kind = DEA_LENS, true;
    case 1:
        return changed->models[0] = dea_model_find("lame"), true;
    case 2:
        return changed->models[changed->model_count++] = dea_model_find("lame"), true;
    case 3:
        return changed->study = DEA_STUDY_AC, true;
    case 4:
        return changed->material.prony_count++, true;
    case 5:
        return changed->material.instantaneous = true, true;
    case 6:
        return changed->drive.waveform.kind = DEA_WAVE_SINE, true;
    case 7:
        return changed->drive.waveform.times = other, changed->drive.waveform.voltages = other,
               changed->drive.waveform.point_count = 2, true;
    case 8:
        return changed->transient.average_count++, true;
    case 9:
        return changed->transient.from_bias = true, true;
    case 10:
        return changed->ac.points_per_decade++, true;
    case 11:
        return changed->axis_count = 0, true;
    case 12:
        return values[1] += 1e-9, true;
    case 13:
        return snprintf(changed->axes[0].key, sizeof axis.key, "drive.voltage"), true;
    case 14:
        return changed->electrode.law = dea_law_find("yeoh"), true; /* which has the constants that the scene has there */
    case 15:
        return changed->electrode.constants[2] += 1.0, true; /* of a skin whose law is a list */
    default:
        return false;
    }
}

static void all_that_is_no_scalar_counts(void **state)
{
    (void)state;
    char *before, *after;
    for (size_t i = 0;; i++) {
        scene = paper_scene(DEA_DOT, 1.2, 0.5, 3000.0);
        scene.models[0] = dea_model_find("lumped");
        scene.study = i == 8 || i == 9 ? DEA_STUDY_TRANSIENT : i == 10 ? DEA_STUDY_AC : DEA_STUDY_SWEEP; /* whose that is */
        values[0] = 0.1, values[1] = 0.2;
        scene.electrode.law = i == 14 ? dea_law_find("neo_hookean") : i == 15 ? dea_law_find("ogden") : NULL;
        scene.electrode.entry_count = i == 15 ? 2 : 1;
        add_axis(&scene, &axis, &scene.actuator.coverage, values, 2);
        assert_int_equal(dea_identity_write(&scene, dea_engine_find("direct"), &before, NULL), DEA_OK);
        const bool changed = change(&scene, i);
        assert_int_equal(dea_identity_write(&scene, dea_engine_find("direct"), &after, NULL), DEA_OK);
        const bool same = strcmp(before, after) == 0;
        free(before);
        free(after);
        if (!changed) {
            assert_true(same && i == 16);
            return;
        }
        if (same) {
            fail_msg("change %zu does not count", i);
        }
    }
}

static void shards_share_the_blocks_among_them(void **state)
{
    (void)state;
    static const size_t blocks[] = {1, 2, 7, 100, 1000003};
    for (size_t i = 0; i < 5; i++) {
        const dea_journal_study cut = {
            .cut = {.points = blocks[i], .total = blocks[i], .block = 1, .blocks_per_model = blocks[i], .blocks = blocks[i]}};
        for (size_t count = 1; count < 300; count++) {
            size_t next = 0;
            for (size_t number = 1; number <= count; number++) {
                const dea_stretch share = dea_shard_blocks(&cut, (dea_shard){number, count});
                assert_true(share.first == next && share.count >= blocks[i] / count && share.count <= blocks[i] / count + 1);
                next += share.count;
            }
            assert_int_equal(next, blocks[i]);
        }
    }
}

static void wrong_usage_is_told(void **state)
{
    (void)state;
    file_write("sweep.yaml", sweep_text, sizeof sweep_text - 1);
    static const char *const shards[] = {
        "0/5", "6/5", "5", "1/", "/5", "1/0", "a/b", "1/5x", "-1/5", "1/1000001", "99999999999999999999/5"};
    for (size_t i = 0; i < sizeof shards / sizeof *shards; i++) {
        RUN("run", "sweep.yaml", "-o", "part.dea", "--shard", shards[i]);
        assert_status(2);
        assert_says("needs I/N with whole numbers 1 <= I <= N <= 1000000, for example 3/10");
    }
    RUN("run", "sweep.yaml", "--shard", "1/2");
    assert_status(2);
    assert_says("--shard needs -o with a file, for example -o part-1.dea");
    RUN("run", "sweep.yaml", "--shard", "1/2", "-o", "-");
    assert_status(2);
    RUN("run", "sweep.yaml", "--shard", "1/2", "-o", "part.dea", "--plot", "x.svg");
    assert_status(2);
    assert_says("give --plot to deaspice merge");
    RUN("run", "sweep.yaml", "--shard", "1/2", "-o", "part.dea", "--format", "csv");
    assert_status(2);
    assert_says("give --format to deaspice merge");
    RUN("run", "sweep.yaml", "--shard", "1/2", "-o", "part.csv");
    assert_status(2);
    assert_says("part-1.dea");
    RUN("check", "sweep.yaml", "--shard", "1/2");
    assert_status(2);
    assert_false(file_exists("part.dea"));
    assert_false(file_exists("part.csv"));
    RUN("merge", "--help");
    assert_status(0);
    assert_non_null(strstr(child_out, "Examples:"));
}

/* Runs a line of the shell with DEASPICE and EXAMPLES set. */
static void shell(const char *line)
{
    char folder[sizeof child_home + 32];
    snprintf(folder, sizeof folder, "%s/examples/cluster", child_home);
    setenv("DEASPICE", child_path, 1);
    setenv("EXAMPLES", folder, 1);
    if (system(line) != 0) {
        fail_msg("%s", line);
    }
}

static void gnu_parallel_makes_the_whole_run(void **state)
{
    (void)state;
    file_write("sweep.yaml", sweep_text, sizeof sweep_text - 1);
    RUN("run", "sweep.yaml", "--engine", "direct", "--set", "drive.voltage=2 kV", "-o", "whole.nc");
    assert_status(0);
    shell(
        "\"$EXAMPLES\"/parallel.sh sweep.yaml parallel.nc 5 --engine direct --set 'drive.voltage=2 kV' >log.txt 2>&1 </dev/null");
    assert_true(same_bytes("whole.nc", "parallel.nc"));
    assert_false(file_exists("parallel.nc.part-1.dea"));
}

static void slurm_makes_the_whole_run(void **state)
{
    (void)state;
    static const char stub[] = "#!/bin/sh\nexec \"$@\"\n";
    file_write("sweep.yaml", sweep_text, sizeof sweep_text - 1);
    file_write("srun", stub, sizeof stub - 1);
    assert_int_equal(chmod("srun", 0755), 0);
    RUN("run", "sweep.yaml", "--engine", "direct", "-o", "whole.nc");
    assert_status(0);
    for (int round = 0; round < 2; round++) { /* tasks that are submitted again keep what they have */
        shell("for i in 1 2 3; do PATH=.:$PATH PARTS=3 SCENE=sweep.yaml OUT=slurm.nc OPTIONS='--engine direct' "
              "SLURM_ARRAY_TASK_ID=$i "
              "SLURM_CPUS_PER_TASK=1 sh \"$EXAMPLES\"/slurm.sh || exit 1; done");
    }
    RUN("merge", "sweep.yaml", "--engine", "direct", "slurm.nc.part-1.dea", "slurm.nc.part-2.dea", "slurm.nc.part-3.dea", "-o",
        "slurm.nc");
    assert_status(0);
    assert_true(same_bytes("whole.nc", "slurm.nc"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(merged_sweep_is_the_whole_run),
        cmocka_unit_test(merged_transients_are_the_whole_run),
        cmocka_unit_test(merged_responses_are_the_whole_run),
        cmocka_unit_test(jobs_change_no_bit_of_a_result),
        cmocka_unit_test(failed_rows_fail_the_shard_and_the_merge),
        cmocka_unit_test(gaps_and_overlaps_are_named),
        cmocka_unit_test(foreign_parts_are_named_with_their_difference),
        cmocka_unit_test(a_journal_gives_back_what_it_took),
        cmocka_unit_test(every_damaged_byte_is_found),
        cmocka_unit_test(every_cut_is_found),
        cmocka_unit_test(the_other_byte_order_is_named),
        cmocka_unit_test(a_block_that_comes_twice_is_named),
        cmocka_unit_test(lost_block_is_computed_again),
        cmocka_unit_test(every_scalar_of_a_scene_counts),
        cmocka_unit_test(all_that_is_no_scalar_counts),
        cmocka_unit_test(shards_share_the_blocks_among_them),
        cmocka_unit_test(wrong_usage_is_told),
        cmocka_unit_test(gnu_parallel_makes_the_whole_run),
        cmocka_unit_test(slurm_makes_the_whole_run),
    };
    return cmocka_run_group_tests(tests, child_enter, child_leave);
}
