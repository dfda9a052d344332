/* What is loaded, and when: SUNDIALS and LAPACKE only by what needs them. */
#include "child_program.h"

#include <math.h>

#include "engine/ida/sundials.h"
#include "support/lapack.h"

#define FILM "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"

static const char scene[] = FILM "material: elastosil-2030\n"
                                 "drive: {voltage: 3 kV}\n"
                                 "model: lumped\n"
                                 "study: {sweep: {coverage: [0.4, 0.5]}}\n";
static const char moving[] = FILM "material: {base: elastosil-2030, retardation: 1 ms}\n"
                                  "drive: {waveform: {step: {on: 1 ms, voltage: 3 kV}}}\n"
                                  "model: lumped\n"
                                  "study: {transient: {until: 10 ms, every: 1 ms}}\n";
static const char pull[] = "stretch,stress_Pa\n1.1,40e3\n1.2,75e3\n1.3,110e3\n1.4,140e3\n";

/* Folders whose libraries are broken, for LD_LIBRARY_PATH: a loader that meets them goes no further. */
static void break_libraries(const char *folder, const char *const *names, size_t count)
{
    char path[300];
    assert_int_equal(mkdir(folder, 0700), 0);
    for (size_t i = 0; i < count; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        file_write(path, "broken", 6);
    }
}

static void one_that_is_missing_stops_only_what_needs_it(void **state)
{
    (void)state;
#if !defined DEA_LAPACKE || !defined DEA_SUNDIALS
    skip();
#else
    static const char *const lapacke[] = {DEA_LAPACKE}, *const sundials[] = {DEA_SUNDIALS};
    break_libraries("no-lapacke", lapacke, sizeof lapacke / sizeof *lapacke);
    break_libraries("no-sundials", sundials, sizeof sundials / sizeof *sundials);
    file_write("scene.yaml", scene, sizeof scene - 1);
    file_write("moving.yaml", moving, sizeof moving - 1);
    file_write("pull.csv", pull, sizeof pull - 1);
    setenv("LD_LIBRARY_PATH", "no-lapacke:no-sundials", 1);
    RUN("--version");
    assert_status(0);
    RUN("run", "scene.yaml", "--engine", "direct");
    assert_status(0);
    RUN("run", "scene.yaml", "--engine", "ngspice");
    assert_status(0);
    RUN("run", "moving.yaml", "--engine", "direct");
    assert_status(0);
    setenv("LD_LIBRARY_PATH", "no-sundials", 1);
    RUN("run", "scene.yaml", "--engine", "ida");
    assert_status(1);
    assert_says("the engine ida needs SUNDIALS");
    RUN("fit", "--uniaxial", "pull.csv", "--terms", "1");
    assert_status(0);
    setenv("LD_LIBRARY_PATH", "no-lapacke", 1);
    RUN("run", "scene.yaml", "--engine", "ida");
    assert_status(0);
    RUN("run", "moving.yaml", "--engine", "ida");
    assert_status(1);
    assert_says("needs the library LAPACKE");
    RUN("fit", "--uniaxial", "pull.csv", "--terms", "1", "-o", "film.yaml");
    assert_status(1);
    assert_says("needs the library LAPACKE");
    assert_false(file_exists("film.yaml"));
    unsetenv("LD_LIBRARY_PATH");
#endif
}

static int threads(void)
{
    char line[200];
    int count = 0;
    FILE *file = fopen("/proc/self/status", "r");
    assert_non_null(file);
    while (count == 0 && fgets(line, sizeof line, file)) {
        (void)sscanf(line, "Threads: %d", &count);
    }
    fclose(file);
    return count;
}

/* A process with threads cannot fork in peace; the variables that keep them away are the user's again afterwards. */
static void lapack_brings_no_threads_and_leaves_the_environment(void **state)
{
    enum { N = 300 };
    static double a[N * N], b[N];
    (void)state;
    setenv("OPENBLAS_NUM_THREADS", "7", 1);
    unsetenv("MKL_NUM_THREADS");
    const int before = threads();
    assert_int_equal(dea_lapack_load(NULL), DEA_OK);
    for (int i = 0; i < N * N; i++) {
        a[i] = (i % (N + 1) == 0 ? N : 0) + i % 7;
        b[i % N] = 1.0;
    }
    assert_int_equal(dea_lapacke_dgels(LAPACK_COL_MAJOR, 'N', N, N, 1, a, N, b, N), 0);
    assert_int_equal(threads(), before);
    assert_string_equal(getenv("OPENBLAS_NUM_THREADS"), "7");
    assert_null(getenv("MKL_NUM_THREADS"));
    unsetenv("OPENBLAS_NUM_THREADS");
}

static void sundials_is_of_the_version_that_was_built_for(void **state)
{
    char version[32];
    dea_sundials sundials;
    dea_error error = {0};
    (void)state;
    assert_int_equal(dea_sundials_open(&sundials, &error), DEA_OK);
    dea_sundials_close(&sundials);
    assert_int_equal(atoi(dea_sundials_version(version, sizeof version)), SUNDIALS_VERSION_MAJOR);
}

static N_Vector filled(N_Vector v, double pace)
{
    for (sunindextype i = 0; i < NV_LENGTH_S(v); i++) {
        NV_Ith_S(v, i) = sin(pace * (double)(i + 1));
    }
    return v;
}

static void assert_same(N_Vector a, N_Vector b)
{
    assert_memory_equal(NV_DATA_S(a), NV_DATA_S(b), (size_t)NV_LENGTH_S(a) * sizeof(sunrealtype));
}

static void check_sums(const dea_sundials *sun, size_t n)
{
    N_Vector x = filled(dea_sundials_vector(sun, n), 1.0), y = filled(sun->N_VClone(x), 2.3), wide = sun->N_VClone(x);
    N_Vector plain = sun->N_VNew_Serial((sunindextype)n, sun->context), parts[] = {x, y, x};
    sunrealtype factors[] = {0.3, -1.7, 1e-3};
    wide->ops->nvlinearsum(0.7, x, -1.3, y, wide);
    plain->ops->nvlinearsum(0.7, x, -1.3, y, plain);
    assert_same(wide, plain);
    wide->ops->nvscale(1.9, wide, wide);
    plain->ops->nvscale(1.9, plain, plain);
    assert_same(wide, plain);
    assert_int_equal(wide->ops->nvlinearcombination(3, factors, parts, wide), 0);
    for (sunindextype i = 0; i < (sunindextype)n; i++) {
        NV_Ith_S(plain, i) = 0.3 * NV_Ith_S(x, i) + -1.7 * NV_Ith_S(y, i) + 1e-3 * NV_Ith_S(x, i);
    }
    assert_same(wide, plain);
    const double norm = plain->ops->nvwrmsnorm(x, y);
    assert_true(fabs(wide->ops->nvwrmsnorm(x, y) - norm) <= 1e-15 * norm);
    N_Vector vectors[] = {x, y, wide, plain};
    for (int i = 0; i < 4; i++) {
        sun->N_VDestroy(vectors[i]);
    }
}

static void check_substitution(const dea_sundials *sun, size_t n)
{
    const sunindextype size = (sunindextype)n;
    N_Vector b = filled(dea_sundials_vector(sun, n), 0.9), x = sun->N_VClone(b);
    SUNMatrix matrix = sun->SUNDenseMatrix(size, size, sun->context);
    SUNLinearSolver solver = sun->SUNLinSol_Dense(b, matrix, sun->context);
    for (sunindextype i = 0; i < size * size; i++) {
        SM_DATA_D(matrix)[i] = sin(1.0 + 0.37 * (double)(i * i)); /* rows have to change places */
    }
    assert_int_equal(solver->ops->setup(solver, matrix), 0);
    assert_int_equal(solver->ops->solve(solver, matrix, x, b, 0.0), 0);
    dea_sundials_substitute(solver, matrix, NV_DATA_S(b));
    assert_same(x, b);
    sun->SUNLinSolFree(solver);
    sun->SUNMatDestroy(matrix);
    sun->N_VDestroy(x);
    sun->N_VDestroy(b);
}

static void wide_sums_and_substitutions_have_the_digits_of_sundials(void **state)
{
    dea_sundials sun;
    dea_error error = {0};
    (void)state;
    assert_int_equal(dea_sundials_open(&sun, &error), DEA_OK);
    for (size_t n = 1; n <= 33; n++) {
        check_sums(&sun, n);
        check_substitution(&sun, n);
    }
    dea_sundials_close(&sun);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_that_is_missing_stops_only_what_needs_it),
        cmocka_unit_test(lapack_brings_no_threads_and_leaves_the_environment),
        cmocka_unit_test(sundials_is_of_the_version_that_was_built_for),
        cmocka_unit_test(wide_sums_and_substitutions_have_the_digits_of_sundials),
    };
    return cmocka_run_group_tests_name("libraries", tests, child_enter, child_leave);
}
