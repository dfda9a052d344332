/* The table of tests/hard as tests, one a case, named as the case. Run from the project's folder. */
#ifndef DEA_TEST_HARD_CASES_H
#define DEA_TEST_HARD_CASES_H

#include "scenes.h"

#include "../hard/cases.h"

/* No case may take longer of a processor with one engine, sanitizers included [s]. */
static const double hard_patience = 120.0;

static inline void hard_check_case(void **state)
{
    const hard_case *c = *state;
    hard_subject subject;
    dea_error error = {0};
    if (!hard_begin(c, "tests/hard", false, &subject, &error)) {
        fail_msg("%s", error.message);
    }
    int bad = 0;
    for (size_t k = 0; k < HARD_ENGINES; k++) {
        static char text[HARD_LOG + 1024];
        const hard_verdict v = hard_try(&subject, k);
        if (hard_shortfall(&c->cells[k], &v, subject.own_error, text, sizeof text)) {
            print_error("%s, %s: %s\n", c->name, hard_engine_names[k], text);
            bad++;
        } else if (v.seconds > hard_patience) {
            print_error("%s, %s: %g s\n", c->name, hard_engine_names[k], v.seconds);
            bad++;
        }
    }
    hard_end(&subject);
    assert_int_equal(bad, 0);
}

/* Does its scene move? */
static inline bool hard_moves(const hard_case *c)
{
    char path[512];
    dea_scene scene;
    dea_error error = {0};
    snprintf(path, sizeof path, "tests/hard/%s.yaml", c->name);
    if (dea_scene_read(path, NULL, 0, NULL, &scene, &error) != DEA_OK) {
        return false; /* its test tells */
    }
    const bool moves = scene.study == DEA_STUDY_TRANSIENT;
    dea_scene_free(&scene);
    return moves;
}

/* Under sanitizers, which ask for memory and not for numbers, every second case in time: they take minutes and share their paths. */
#ifdef __SANITIZE_ADDRESS__
enum { HARD_EVERY = 2 };
#else
enum { HARD_EVERY = 1 };
#endif

/* All cases in time, or all others. */
static inline int hard_run_all(bool moving)
{
    struct CMUnitTest tests[HARD_CASES];
    size_t count = 0, moved = 0;
    for (size_t i = 0; i < HARD_CASES; i++) {
        const hard_case *c = &hard_cases[i];
        if (hard_moves(c) == moving && (!moving || moved++ % HARD_EVERY == 0)) {
            tests[count++] =
                (struct CMUnitTest){.name = c->name, .test_func = hard_check_case, .initial_state = (void *)(uintptr_t)c};
        }
    }
    return _cmocka_run_group_tests("hard", tests, count, NULL, NULL);
}

#endif
