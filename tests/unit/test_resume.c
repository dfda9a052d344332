/* Runs that go on where they stopped, however they stopped. */
#define _GNU_SOURCE
#include "child_program.h"

#include <errno.h>

#include "deaspice/deaspice.h"
#include "journal/journal.h"

enum { POINTS = 24000, BLOCK = 375, BLOCKS = 64, PACKED = 65, KILLS = 20 };

static const char scene_text[] =
    "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
    "material: elastosil-2030\n"
    "drive: {voltage: 3 kV}\n"
    "model: coverage\n"
    "study: {sweep: {prestretch: {from: 1.1, to: 1.3, points: 120}, coverage: {from: 0.1, to: 0.9, points: 200}}}\n";
static const char step_text[] =
    "actuator: {kind: dot, frame_radius: 30 mm, electrode_radius: 15 mm, film_thickness: 100 um, prestretch: 1.2}\n"
    "material: {base: elastosil-2030, density: 1080 kg/m^3, retardation: 1 ms}\n"
    "drive: {waveform: {step: {on: 10 ms, off: 60 ms, voltage: 3 kV, rise: 0 s}}}\n"
    "model: lumped\n"
    "study: {transient: {until: 100 ms, every: 1 ms, average: {from: 40 ms, to: 60 ms}}, over: {electrode_radius: [5 mm, 15 mm, "
    "30 mm]}}\n";

static const char target[] = "result.csv", journal[] = "result.csv.journal";

#define RESUME "run", "scene.yaml", "--engine", "ngspice", "-j", "2", "-o", target, "--resume"

static int enter(void **state)
{
    const int entered = child_enter(state);
    if (entered != 0) {
        return entered;
    }
    file_write("scene.yaml", scene_text, sizeof scene_text - 1);
    file_write("step.yaml", step_text, sizeof step_text - 1);
    RUN("run", "scene.yaml", "--engine", "ngspice", "-j", "1", "-q", "-o", "whole.csv");
    return child_status;
}

static void pause_for(long microseconds)
{
    nanosleep(&(struct timespec){.tv_sec = microseconds / 1000000, .tv_nsec = microseconds % 1000000 * 1000}, NULL);
}

/* Bytes of a header: what is in the journal before the first block. */
static long header_size(void)
{
    size_t size;
    char *bytes = file_read(journal, &size);
    const char *mark = memmem(bytes, size, "deablock", 8);
    const long header = mark ? (long)(mark - bytes) : (long)size;
    free(bytes);
    return header;
}

/* Points of the whole records in the journal, found without the library. */
static size_t points_kept(void)
{
    size_t size, points = 0;
    char *bytes = file_read(journal, &size);
    for (size_t at = (size_t)header_size(); at + 32 <= size;) {
        uint64_t count;
        assert_memory_equal(bytes + at, "deablock", 8);
        memcpy(&count, bytes + at + 16, sizeof count);
        assert_int_equal(count, BLOCK);
        at += 32 + (size_t)count * PACKED + 8;
        points += at <= size ? (size_t)count : 0;
    }
    free(bytes);
    return points;
}

/* Starts the run and waits until its journal has so many bytes, or it ended. */
static pid_t run_until(long bytes)
{
    const pid_t pid = child_start(0, WORDS(RESUME));
    for (siginfo_t about = {0}; file_size(journal) < bytes; pause_for(200)) {
        assert_int_equal(waitid(P_PID, (id_t)pid, &about, WEXITED | WNOHANG | WNOWAIT), 0);
        if (about.si_pid == pid) {
            break;
        }
    }
    return pid;
}

static void expect(const char *format, size_t one, size_t other)
{
    char words[128];
    snprintf(words, sizeof words, format, one, other);
    assert_says(words);
}

static void resume_completes(size_t kept)
{
    RUN(RESUME);
    assert_status(0);
    expect("deaspice: %zu of %zu points taken over", kept, POINTS);
    expect("%zu points taken over, %zu computed", kept, POINTS - kept);
    assert_true(same_bytes(target, "whole.csv"));
    assert_false(file_exists(journal));
}

static void run_with_a_journal_is_the_run_without(void **state)
{
    (void)state;
    remove(target);
    resume_completes(0);
}

/* 20 moments over the whole run: at its start, after every part of its blocks, and while the result is written. */
static void killed_run_goes_on_without_computing_anything_twice(void **state)
{
    (void)state;
    const long full = POINTS * PACKED + BLOCKS * 40;
    unsigned long seed = 20240229;
    size_t hit = 0;
    for (long i = 0; i < KILLS; i++) {
        remove(target);
        remove(journal);
        seed = seed * 6364136223846793005UL + 1442695040888963407UL;
        const long share = full / (KILLS - 3), more = (long)(seed >> 33) % share;
        const pid_t pid = run_until(i == 0 ? 0 : 2500 + (i - 1) * share + more);
        pause_for((long)(seed >> 40) % 8000);
        kill(pid, SIGKILL);
        child_wait(pid);
        if (child_status == 0) { /* it was faster */
            assert_true(same_bytes(target, "whole.csv"));
            continue;
        }
        assert_int_equal(child_status, -SIGKILL);
        assert_false(file_exists(target) && !same_bytes(target, "whole.csv"));
        hit++;
        resume_completes(file_exists(journal) ? points_kept() : 0);
    }
    assert_true(hit > KILLS / 2);
}

static void run_killed_again_and_again_ends_where_it_would(void **state)
{
    (void)state;
    remove(target);
    size_t kept = 0;
    for (long i = 1; i < 6; i++) {
        const pid_t pid = run_until(i * (POINTS * PACKED / 7));
        kill(pid, SIGKILL);
        child_wait(pid);
        assert_int_equal(child_status, -SIGKILL);
        assert_true(points_kept() >= kept);
        kept = points_kept();
        assert_true(kept > 0);
    }
    resume_completes(kept);
}

static void signal_keeps_the_journal_and_says_so(void **state)
{
    (void)state;
    remove(target);
    const pid_t pid = run_until(POINTS * PACKED / 2);
    kill(pid, SIGTERM);
    child_wait(pid);
    assert_int_equal(child_status, -SIGTERM);
    assert_false(file_exists(target));
    const size_t kept = points_kept();
    assert_true(kept >= POINTS / 3 && kept <= POINTS);
    expect("interrupted; %zu of %zu points are kept in result.csv.journal, --resume goes on with them", kept, POINTS);
    resume_completes(kept);
}

static void second_run_on_a_journal_is_refused(void **state)
{
    (void)state;
    remove(target);
    const pid_t pid = run_until(10000);
    kill(pid, SIGSTOP);
    const pid_t other = child_start(0, WORDS(RESUME));
    child_wait(other);
    assert_status(2);
    assert_says("result.csv.journal is in use by another run");
    kill(pid, SIGCONT);
    child_wait(pid);
    assert_int_equal(child_status, 0);
    assert_true(same_bytes(target, "whole.csv"));
}

static void torn_end_is_cut_off_and_computed_again(void **state)
{
    (void)state;
    remove(target);
    const pid_t pid = run_until(POINTS * PACKED / 2);
    kill(pid, SIGTERM);
    child_wait(pid);
    const size_t kept = points_kept();
    assert_int_equal(truncate(journal, file_size(journal) - 1000), 0);
    const size_t less = points_kept();
    assert_true(less < kept);
    resume_completes(less);
    assert_says("bytes are no whole block and were cut off");
}

static void damaged_block_is_computed_again(void **state)
{
    (void)state;
    remove(target);
    const pid_t pid = run_until(POINTS * PACKED / 2);
    kill(pid, SIGTERM);
    child_wait(pid);
    const int fd = open(journal, O_WRONLY);
    assert_int_equal(pwrite(fd, "#", 1, file_size(journal) - 2000), 1);
    close(fd);
    RUN(RESUME);
    assert_status(0);
    assert_says("were cut off");
    assert_true(same_bytes(target, "whole.csv"));
}

enum { RECORD = 32 + BLOCK * PACKED + 8 };

/* Ways to damage the records from the third on, and how many of them that costs. */
typedef struct wound {
    long at, cut, put; /* place behind the begin of the third record; bytes that go, bytes that come */
    size_t lost;
} wound;

static const wound wounds[] = {
    {1000, 1, 1, 1},             /* a point */
    {9, 1, 1, 1},                /* a head */
    {RECORD - 4, 1, 1, 1},       /* a digest */
    {RECORD - 100, 200, 200, 2}, /* over the end of a record */
    {500, 700, 0, 1},            /* bytes are missing */
    {0, 0, 4321, 0},             /* bytes come between records */
    {20, 2 * RECORD, 77, 3},
};

static void inflict(const wound *w, const char *name, const char *bytes, size_t size, size_t header)
{
    static const char junk[8192] = "deablock";
    const size_t at = header + 2 * RECORD + (size_t)w->at, rest = at + (size_t)w->cut;
    FILE *file = fopen(name, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, at, file), at);
    assert_int_equal(fwrite(junk, 1, (size_t)w->put, file), (size_t)w->put);
    assert_int_equal(fwrite(bytes + rest, 1, size - rest, file), size - rest);
    assert_int_equal(fclose(file), 0);
}

static void damaged_middle_costs_its_blocks_alone(void **state)
{
    (void)state;
    size_t size;
    remove(target);
    const pid_t pid = run_until(POINTS * PACKED * 9 / 10);
    kill(pid, SIGTERM);
    child_wait(pid);
    const size_t kept = points_kept(), header = (size_t)header_size();
    char *bytes = file_read(journal, &size);
    for (size_t i = 0; i < sizeof wounds / sizeof *wounds; i++) {
        inflict(&wounds[i], journal, bytes, size, header);
        remove(target);
        resume_completes(kept - wounds[i].lost * BLOCK);
        assert_says("bytes in it are damaged; what they held is computed again, what follows them is kept");
    }
    free(bytes);
}

static void damaged_part_is_named_and_made_whole(void **state)
{
    (void)state;
    static const char *const words[] = {"run", "scene.yaml", "--engine", "ngspice",    "-j",       "2", "--shard",
                                        "2/2", "-q",         "-o",       "part-2.dea", "--resume", NULL};
    size_t size;
    RUN("run", "scene.yaml", "--engine", "ngspice", "--shard", "1/2", "-o", "part-1.dea");
    child_wait(child_start(0, words));
    assert_status(0);
    char *bytes = file_read("part-2.dea", &size);
    for (size_t i = 0; i < sizeof wounds / sizeof *wounds; i++) {
        inflict(&wounds[i], "part-2.dea", bytes, size, size - 32 * (size_t)RECORD);
        RUN("merge", "scene.yaml", "--engine", "ngspice", "part-1.dea", "part-2.dea", "-o", "merged.csv");
        assert_status(wounds[i].lost > 0 ? 2 : 0);
        assert_true(file_exists("merged.csv") == (wounds[i].lost == 0));
        if (wounds[i].lost > 0) {
            assert_says("part-2.dea is damaged");
            child_wait(child_start(0, words));
            assert_status(0);
            RUN("merge", "scene.yaml", "--engine", "ngspice", "part-1.dea", "part-2.dea", "-o", "merged.csv");
            assert_status(0);
        }
        assert_true(same_bytes("merged.csv", "whole.csv"));
        remove("merged.csv");
    }
    free(bytes);
    remove("part-1.dea");
    remove("part-2.dea");
}

/* The first child of a process, 0 where it has none. */
static pid_t worker_of(pid_t parent)
{
    char name[64];
    int worker = 0;
    snprintf(name, sizeof name, "/proc/%d/task/%d/children", (int)parent, (int)parent);
    FILE *file = fopen(name, "r");
    if (!file || fscanf(file, "%d", &worker) != 1) {
        worker = 0;
    }
    if (file) {
        fclose(file);
    }
    return worker;
}

/* Whoever takes workers away in the middle of a run takes nothing from the result. */
static void run_whose_workers_are_taken_has_the_same_bytes(void **state)
{
    (void)state;
    static const int signals[] = {SIGKILL, SIGSTOP, SIGKILL, SIGSEGV, SIGKILL, SIGSTOP};
    remove(target);
    size_t taken = 0;
    pid_t last = 0;
    const pid_t pid = child_start(0, WORDS(RESUME));
    for (siginfo_t about = {0}; about.si_pid != pid && taken < 6; pause_for(200)) {
        const pid_t worker = file_size(journal) > (long)taken * 2 * RECORD ? worker_of(pid) : 0;
        assert_int_equal(waitid(P_PID, (id_t)pid, &about, WEXITED | WNOHANG | WNOWAIT), 0);
        if (worker > 0 && worker != last && kill(worker, signals[taken]) == 0) {
            last = worker;
            taken++;
        }
    }
    child_wait(pid);
    assert_status(0);
    assert_true(taken > 0);
    assert_true(same_bytes(target, "whole.csv"));
    assert_false(file_exists(journal));
}

static void torn_header_is_a_new_journal(void **state)
{
    (void)state;
    remove(target);
    const pid_t pid = run_until(10000);
    kill(pid, SIGTERM);
    child_wait(pid);
    assert_true(file_exists(journal));
    assert_int_equal(truncate(journal, 700), 0);
    resume_completes(0);
}

static void foreign_journal_is_refused_and_stays(void **state)
{
    (void)state;
    size_t size;
    remove(target);
    const pid_t pid = run_until(10000);
    kill(pid, SIGTERM);
    child_wait(pid);
    const size_t kept = points_kept();
    char *before = file_read(journal, &size);
    file_write("before", before, size);
    free(before);
    RUN(RESUME, "--set", "drive.voltage=2 kV");
    assert_status(2);
    assert_says("result.csv.journal belongs to another study: drive.voltage is 3000 there and 2000 here");
    assert_true(same_bytes("before", journal));
    RUN("run", "scene.yaml", "--engine", "direct", "-o", target, "--resume");
    assert_status(2);
    assert_says("engine is ngspice there and direct here");
    assert_true(same_bytes("before", journal));
    resume_completes(kept);
    file_write(journal, "my notes\n", 9);
    RUN(RESUME);
    assert_status(2);
    assert_int_equal(file_size(journal), 9);
    remove(journal);
}

static void full_disk_is_told_and_what_is_there_goes_on(void **state)
{
    (void)state;
    remove(target);
    child_wait(child_start(300000, WORDS(RESUME)));
    assert_status(1);
    assert_says("cannot write result.csv.journal: ");
    assert_false(file_exists(target));
    const size_t kept = points_kept();
    assert_true(kept > 0 && kept < POINTS / 2);
    child_wait(child_start(POINTS * PACKED + 200000, WORDS(RESUME))); /* room for the journal, not for the result */
    assert_status(1);
    assert_says("cannot write result.csv: ");
    resume_completes(POINTS);
}

static void unwritable_target_is_told_before_the_run(void **state)
{
    (void)state;
    RUN("run", "scene.yaml", "-o", "missing/result.csv", "--resume");
    assert_status(1);
    assert_says("missing/result.csv");
    RUN("run", "scene.yaml", "-o", ".", "--resume");
    assert_status(1);
    RUN("run", "scene.yaml", "-o", "result.txt", "--resume");
    assert_status(2);
    assert_says("names no format");
    assert_false(file_exists("result.txt.journal"));
    static const char *const targets[] = {"-", "/dev/null"};
    for (size_t i = 0; i < 2; i++) {
        RUN("run", "scene.yaml", "-o", targets[i], "--resume");
        assert_status(2);
        assert_says("--resume needs -o with a file");
    }
    RUN("run", "scene.yaml", "--resume");
    assert_status(2);
    assert_says("--resume needs -o with a file");
}

/* The part of a whole study is its journal. */
static void failed_rows_and_averages_of_a_journal_are_told(void **state)
{
    (void)state;
    RUN("run", "step.yaml", "--engine", "direct", "-o", "step.nc");
    assert_status(1);
    char averages[CHILD_TEXT];
    memcpy(averages, child_out, sizeof averages);
    RUN("run", "step.yaml", "--engine", "direct", "--shard", "1/1", "-o", "other.nc.journal");
    assert_status(1);
    RUN("run", "step.yaml", "--engine", "direct", "-o", "other.nc", "--resume");
    assert_status(1);
    assert_says("3 runs taken over, 0 computed");
    assert_says("101 rows were not solved");
    assert_string_equal(child_out, averages);
    assert_true(same_bytes("step.nc", "other.nc"));
    assert_false(file_exists("other.nc.journal"));
}

static void killed_shard_goes_on(void **state)
{
    (void)state;
    static const char part[] = "part-1.dea.journal";
    const char *const words[] = {"run", "scene.yaml", "--engine",   "ngspice",  "--shard",
                                 "1/2", "-o",         "part-1.dea", "--resume", NULL};
    const pid_t pid = child_start(0, words);
    while (file_size(part) < POINTS * PACKED / 4) {
        pause_for(200);
    }
    kill(pid, SIGKILL);
    child_wait(pid);
    assert_int_equal(child_status, -SIGKILL);
    assert_false(file_exists("part-1.dea"));
    child_wait(child_start(0, words));
    assert_status(0);
    assert_false(file_exists(part));
    child_wait(child_start(0, words)); /* a part that is there is taken over as it is */
    assert_status(0);
    expect("%zu points taken over, %zu computed", 32 * BLOCK, 0);
    RUN("run", "scene.yaml", "--engine", "ngspice", "--shard", "2/2", "-o", "part-1.dea", "--resume");
    assert_status(2);
    assert_says("part-1.dea is of shard 1/2, not of 2/2");
    RUN("run", "scene.yaml", "--engine", "ngspice", "--shard", "2/2", "-o", "part-2.dea");
    assert_status(0);
    RUN("merge", "scene.yaml", "--engine", "ngspice", "part-1.dea", "part-2.dea", "-o", "merged.csv");
    assert_status(0);
    assert_true(same_bytes("merged.csv", "whole.csv"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(run_with_a_journal_is_the_run_without),
        cmocka_unit_test(killed_run_goes_on_without_computing_anything_twice),
        cmocka_unit_test(run_killed_again_and_again_ends_where_it_would),
        cmocka_unit_test(signal_keeps_the_journal_and_says_so),
        cmocka_unit_test(second_run_on_a_journal_is_refused),
        cmocka_unit_test(torn_end_is_cut_off_and_computed_again),
        cmocka_unit_test(damaged_block_is_computed_again),
        cmocka_unit_test(damaged_middle_costs_its_blocks_alone),
        cmocka_unit_test(damaged_part_is_named_and_made_whole),
        cmocka_unit_test(run_whose_workers_are_taken_has_the_same_bytes),
        cmocka_unit_test(torn_header_is_a_new_journal),
        cmocka_unit_test(foreign_journal_is_refused_and_stays),
        cmocka_unit_test(full_disk_is_told_and_what_is_there_goes_on),
        cmocka_unit_test(unwritable_target_is_told_before_the_run),
        cmocka_unit_test(failed_rows_and_averages_of_a_journal_are_told),
        cmocka_unit_test(killed_shard_goes_on),
    };
    return cmocka_run_group_tests(tests, enter, child_leave);
}
