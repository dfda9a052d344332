#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "program/program.h"
#include "support/atomic.h"

/* A scene to start from. */
typedef struct start {
    const char *name;    /* of its file too, with the ending .yaml */
    const char *summary; /* one line */
    const char *text;
} start;

#define ACTUATOR(kind, radius_key)                                                                                               \
    "actuator:\n"                                                                                                                \
    "  kind: " kind "\n"                                                                                                         \
    "  frame_radius: 30 mm        # of the rigid frame that holds the film\n"                                                    \
    "  coverage: 0.5              # radius of the inner region over frame_radius; or " radius_key ": 15 mm\n"                    \
    "  film_thickness: 100 um     # before pre-stretch\n"                                                                        \
    "  prestretch: 1.2            # >= 1, the same in all directions\n"

#define MATERIAL                                                                                                                 \
    "material: elastosil-2030     # deaspice materials lists what is built in; or a file, or constants:\n"                       \
    "# material: film.yaml        # deaspice fit makes one of measured data\n"                                                   \
    "# material: {yeoh: {C1: 178426 Pa, C2: -6023 Pa, C3: 4234 Pa}, permittivity: 2.8, density: 1080 kg/m^3}\n"

#define MOVING                                                                                                                   \
    "material:\n"                                                                                                                \
    "  base: elastosil-2030       # deaspice materials lists what is built in; or a file, for example of deaspice fit\n"         \
    "  retardation: 1 ms          # damping of the film (Kelvin-Voigt)\n"                                                        \
    "  # prony: [{g: 0.2, tau: 0.5 s}]   # relaxation: shares of the modulus and times\n"                                        \
    "  # shift: {wlf: {C1: 17.4, C2: 51.6 K, reference: 20 degC}}   # of the times, at  temperature: 40 degC  beside material\n"

static const start starts[] = {
    {"dot", "one operating point of a dot actuator",
     "# A dot actuator under a voltage: the electrode covers the disc in the middle, which grows.\n"
     "#   deaspice run dot.yaml\n"
     "#   deaspice run dot.yaml --set voltage='3 kV' --model field\n"
     "title: dot actuator\n" ACTUATOR("dot                  # the electrode is the disc; lens: the annulus around it",
                                      "electrode_radius") MATERIAL
     "drive:\n"
     "  voltage: 4.5 kV\n"
     "model: ring                  # or pelrine, constant_force, lumped, coverage, lame, field; or a list of them, or auto\n"
     "study:\n"
     "  sweep: {}                  # the scene as one point; deaspice init sweep has axes\n"},
    {"lens", "aperture of a tunable lens over voltage",
     "# A lens: the electrode covers the annulus, the disc in the middle shrinks and bulges more.\n"
     "#   deaspice run lens.yaml -o lens.csv --plot lens.svg\n"
     "title: tunable lens\n" ACTUATOR(
         "lens                 # the electrode is the annulus; dot: the disc",
         "lens_radius") "  optics:                    # optional: gives the focal length\n"
                        "    focal_length: 60 mm      # at rest\n"
                        "    refractive_index: 1.4    # of the liquid\n" MATERIAL "drive:\n"
                        "  voltage: 4.5 kV\n"
                        "model: ring                  # or lumped, coverage, lame, field; or a list of them, or auto\n"
                        "study:\n"
                        "  sweep:\n"
                        "    voltage: {from: 0 V, to: 4.5 kV, points: 46}\n"},
    {"transient", "motion of a dot actuator that is switched on and off",
     "# A voltage is switched on and off again: displacement, velocity and current over time.\n"
     "#   deaspice run transient.yaml -o transient.csv --plot transient.svg\n"
     "title: switched on and off\n" ACTUATOR("dot                  # or lens", "electrode_radius") MOVING
     "drive:\n"
     "  waveform:                  # in place of voltage; also points, sine, pulse, square, triangle, chirp, burst, sines, file\n"
     "    step: {on: 0.1 s, off: 0.6 s, voltage: 4.5 kV, rise: 1 ms}\n"
     "  series_resistance: 1 MOhm  # of source and electrodes; optional\n"
     "model: ring                  # or lumped, coverage, lame\n"
     "study:\n"
     "  transient:\n"
     "    until: 1 s\n"
     "    every: 1 ms              # a row each\n"
     "    average: {from: 0.5 s, to: 0.6 s}   # optional: means over a window\n"
     "    # over: {coverage: [0.3, 0.5, 0.7]} # a run each\n"},
    {"ac", "frequency response of a dot actuator about its bias",
     "# A small voltage on top of a bias: displacement per volt and impedance over frequency.\n"
     "#   deaspice run ac.yaml -o ac.csv --plot ac.svg\n"
     "title: frequency response\n" ACTUATOR("dot                  # or lens", "electrode_radius") MOVING
     "drive:\n"
     "  series_resistance: 1 MOhm  # of source and electrodes; optional\n"
     "model: ring                  # or lumped, coverage, lame\n"
     "study:\n"
     "  ac:\n"
     "    from: 1 Hz\n"
     "    to: 10 kHz\n"
     "    points_per_decade: 50\n"
     "    bias: 4.5 kV\n"},
    {"modes", "resonances of the membrane of a dot actuator against bias",
     "# Frequency, damping ratio and share of the edge of the slowest modes, a run for each bias.\n"
     "#   deaspice run modes.yaml -o modes.csv --plot modes.svg\n"
     "title: modes against bias\n" ACTUATOR("dot                  # or lens", "electrode_radius") MOVING
     "model: field                 # or one with one mode: lumped, coverage, lame, ring\n"
     "study:\n"
     "  modes:\n"
     "    count: 3\n"
     "    # points: 101            # shapes at so many radii\n"
     "    over:\n"
     "      bias: {from: 0 V, to: 4.5 kV, points: 19}   # or one: bias: 3 kV beside count\n"},
    {"profile", "stretches, stresses and field of a dot actuator over its radius",
     "# The static film from the centre to the frame: where it is nearest to breakdown and to slack.\n"
     "#   deaspice run profile.yaml -o profile.csv --plot profile.svg\n"
     "title: film along its radius\n" ACTUATOR("dot                  # or lens", "electrode_radius") MATERIAL
     "drive:\n"
     "  voltage: 4.5 kV\n"
     "model: field                 # or ring, coverage; or a list of them\n"
     "study:\n"
     "  profile:\n"
     "    points: 101\n"
     "    # over: {voltage: [2 kV, 4 kV]}   # a run each\n"},
    {"force", "force of a dot actuator over the displacement at which its edge is held",
     "# What the actuator exerts on something that holds its edge, outward: from the blocked force to where it rests.\n"
     "#   deaspice run force.yaml -o force.csv --plot force.svg\n"
     "title: force over displacement\n" ACTUATOR("dot                  # or lens", "electrode_radius") MATERIAL
     "drive:\n"
     "  voltage: 4.5 kV\n"
     "model: field                 # or ring, lame, coverage, lumped; or a list of them\n"
     "study:\n"
     "  force:\n"
     "    displacement: {from: 0 mm, to: 0.6 mm, points: 61}\n"
     "    over: {voltage: [3 kV, 4.5 kV]}   # a curve each\n"},
    {"sweep", "a map of a dot actuator over coverage and pre-stretch, models compared",
     "# Any scalar of the scene can be an axis; every combination is one point.\n"
     "#   deaspice run sweep.yaml -o sweep.csv --plot sweep.svg      (or -o sweep.nc, which opens in xarray)\n"
     "#   deaspice check sweep.yaml                                  the same by every engine, side by side\n"
     "title: coverage and pre-stretch\n" ACTUATOR("dot                  # or lens", "electrode_radius") MATERIAL
     "drive:\n"
     "  voltage: 4.5 kV\n"
     "model: [lumped, ring]        # one model, or several to compare\n"
     "study:\n"
     "  sweep:\n"
     "    coverage: {from: 0.05, to: 0.95, points: 91}   # with spacing: log where wanted\n"
     "    prestretch: [1.1, 1.2, 1.3]\n"
     "    # material.yeoh.C1: [160 kPa, 180 kPa]         # by its path, or the end of it\n"},
};

enum { STARTS = sizeof starts / sizeof *starts };

static const char *start_word(size_t index, char room[DEA_NAME_LENGTH])
{
    (void)room;
    return index < STARTS ? starts[index].name : NULL;
}

static const start *start_find(const char *name)
{
    size_t index;
    return dea_word_choose("kind of scene", name, start_word, &index) ? &starts[index] : NULL;
}

static dea_exit print_list(void)
{
    for (size_t i = 0; i < STARTS; i++) {
        printf("%-10s %s\n", starts[i].name, starts[i].summary);
    }
    return DEA_EXIT_DONE;
}

/* An own scene is not lost to a new one. */
static bool is_taken(const dea_arguments *arguments, const char *path)
{
    struct stat about;
    if (arguments->force || strcmp(path, "-") == 0 || stat(path, &about) != 0 || !S_ISREG(about.st_mode)) {
        return false;
    }
    dea_complain("%s is there already; choose another name, or give --force", path);
    return true;
}

static dea_exit run(const dea_arguments *arguments)
{
    if (arguments->operand_count == 0) {
        return print_list();
    }
    dea_error error = {0};
    const start *given = start_find(arguments->operands[0].path);
    const char *path = arguments->output ? arguments->output : "-";
    if (!given || is_taken(arguments, path)) {
        return DEA_EXIT_USAGE;
    }
    dea_signals_catch();
    if (dea_atomic_put(path, given->text, strlen(given->text), &error) != DEA_OK) {
        return dea_complain_error(&error);
    }
    if (arguments->output && !arguments->quiet) {
        fprintf(stderr, "%s is made; next: deaspice run %s\n", path, path);
    }
    return DEA_EXIT_DONE;
}

const dea_command dea_command_init = {
    .name = "init",
    .summary = "a commented scene to start from",
    .help = "Usage: deaspice init [OPTION]... [KIND]\n"
            "\n"
            "Writes a commented scene that runs as it is: dot, lens, transient, ac, modes,\n"
            "profile, force or sweep. Without KIND, lists them.\n"
            "\n",
    .further = "Example:\n"
               "  deaspice init dot -o dot.yaml && deaspice run dot.yaml\n",
    .takes = DEA_TAKES_OUTPUT | DEA_TAKES_QUIET,
    .least = 0,
    .most = 1,
    .words = start_word,
    .run = run,
};
