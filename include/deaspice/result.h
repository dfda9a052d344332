/** @file result.h
 * Rows of a study: of a static point, of a transient, of a frequency response, and how they lie in memory.
 */
#ifndef DEASPICE_RESULT_H
#define DEASPICE_RESULT_H

#include "deaspice/scene.h"
#include "deaspice/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/** States of a static point: code, name, meaning. */
#define DEA_STATE_LIST(X)                                                                                                        \
    X(DEA_STATE_OK, "ok", "equilibrium within all limits")                                                                       \
    X(DEA_STATE_SLACK, "slack", "a region lost its tension: the film wrinkles")                                                  \
    X(DEA_STATE_PULL_IN, "pull_in", "no equilibrium connected to rest")                                                          \
    X(DEA_STATE_BREAKDOWN, "breakdown", "true field above the breakdown strength")                                               \
    X(DEA_STATE_FAILED, "failed", "not solved")

typedef enum dea_state {
#define X(code, name, meaning) code,
    DEA_STATE_LIST(X)
#undef X
        DEA_STATE_COUNT
} dea_state;

/** Static result of one point; with pull_in and failed all numbers are NAN. */
typedef struct dea_row {
    double strain;       /**< s, radial strain of the disc edge [1] */
    double displacement; /**< u, outward [m] */
    double force;        /**< F_DEA over the full circumference, outward [N] */
    double field;        /**< true field in the electroded film, its largest value [V/m] */
    double capacitance;  /**< of the deformed film, as its model has it (physics: section 5), so that F_DEA = U^2/2 dC/du [F] */
    double charge;       /**< C U, signed as the voltage [C] */
    double area_strain;  /**< change of the electroded area over that at rest: disc of a dot, annulus of a lens [1] */
    double focal_length; /**< of a lens with optics [m]; NAN: none, or no cap of liquid has the focal length at rest */
    double energy;       /**< of the electric field in the film, C U^2/2: what a recovering driver gets back [J] */
    double second_field; /**< largest true field in a second film on the edge [V/m], 0: there is none */
    dea_state state;
} dea_row;

/** A row that was not solved. */
DEA_API dea_row dea_row_failed(void);

/** Name of a state as results print it. */
DEA_API const char *dea_state_name(dea_state state);

/** Numeric columns of a row, the focal length only for a lens with optics: name, unit, offset in dea_row; the state column follows them. */
typedef struct dea_column {
    const char *name;      /**< e.g. "displacement_m" */
    const char *long_name; /**< e.g. "radial displacement of the disc edge" */
    const char *unit;      /**< SI, "1" without dimension */
    size_t offset;         /**< of the double in dea_row */
} dea_column;

enum { DEA_ROW_COLUMNS = 10 };
DEA_API extern const dea_column dea_row_columns[DEA_ROW_COLUMNS];

/** Where a film along its radius is nearest to its limits, by the radius at rest and 0 V. */
typedef struct dea_weakest {
    double field;          /**< largest true field [V/m] */
    double field_radius;   /**< where [m]; of a static disc, which is uniform, 0; in time NAN where the field is uniform */
    double tension;        /**< smallest true stress in the plane [Pa] */
    double tension_radius; /**< where [m]; in time NAN where the tension is uniform */
} dea_weakest;

/** One sample of a transient; from a pull_in or failed on, all numbers but time and voltage are NAN. */
typedef struct dea_sample {
    double time;         /**< [s] */
    double voltage;      /**< of the source, before an edge that lies at this very time [V] */
    double displacement; /**< u, outward [m] */
    double strain;       /**< s [1] */
    double velocity;     /**< du/dt [m/s] */
    double force;        /**< F_DEA over the full circumference, outward [N] */
    double current;      /**< of the source, where the scene has an electrical port [A] */
    double charge;       /**< of the film, where the scene has an electrical port [C] */
    double focal_length; /**< of a lens with optics [m] */
    double film_voltage; /**< across the film, where the scene has a series resistance [V] */
    double capacitance;  /**< of the film as it is deformed, where the scene has an electrical port [F] */
    dea_state state;
    dea_weakest weakest; /**< where the scene wants its film along the radius */
} dea_sample;

/** Means over a window of time. */
typedef struct dea_average {
    double strain;       /**< [1] */
    double displacement; /**< [m] */
} dea_average;

/** What a transient tells besides its samples. Energies are those between start and end of the run [J]. */
typedef struct dea_summary {
    double error;    /**< estimated error of the displacement, relative to its peak, with what is left out [1] */
    double velocity_error; /**< estimated error of the velocity, relative to the larger of its peak and the peak of the
                              displacement over the run's fastest time [1], with what is left out */
    double current_error;  /**< of the source's current in the same way, with the charge of the film [1]; NAN: no electrical port */
    double omitted;  /**< bound of what is left out, relative to the peak [1], 0: nothing is */
    double work;     /**< put in by the source */
    double electric; /**< stored in the film's capacitance */
    double elastic;  /**< stored in springs, those of the branches too */
    double kinetic;
    double dissipated; /**< in dampers, branches and resistances */
    double residual;   /**< of the balance of these, relative to the largest of them on the way [1] */
    double resonance;  /**< of the damped swing of the free film, at rest and 0 V [Hz]; NAN: it does not swing */
    double decay;      /**< of that swing [1/s], 0: undamped; NAN: none */
    /** Largest magnitude of the source's current, between samples too, within ten times the accuracy [A], and when [s]; NAN where
     * the voltage jumps and no series resistance limits it, or the run leaves out what moves or charges the film in between. */
    double peak_current, peak_time;
    /** Means of the solution over the scene's windows, integrated by the engine whatever the samples, each within the accuracy of
     * the displacement's peak; NAN for those that the scene does not have and where the film has no number in the window. */
    dea_average averages[DEA_WINDOWS];
} dea_summary;

/** One frequency of an AC study. */
typedef struct dea_response {
    double frequency;          /**< [Hz] */
    double displacement;       /**< magnitude of displacement per volt of the source [m/V] */
    double displacement_phase; /**< [deg], -180 < phase <= 180 */
    double impedance;          /**< magnitude of the input impedance, series resistance included [Ohm] */
    double impedance_phase;    /**< [deg] */
    dea_state state;
} dea_response;

/** What a frequency response tells, between its frequencies too; a resonance and a bandwidth that the range does not hold are
 * NAN. */
typedef struct dea_band {
    double resonance; /**< highest peak of the displacement per volt inside the range [Hz] */
    double bandwidth; /**< where it first falls to 1/sqrt(2) of its value at the lowest frequency [Hz] */
} dea_band;

/** One mode of small motion about the equilibrium under the bias: with the shape phi(R), sum m phi^2 = 1 over the film's mass, of
 * K phi = w^2 M phi, the relaxed stiffness K at constant film voltage. */
typedef struct dea_mode {
    double number;        /**< 1: the slowest */
    double frequency;     /**< |Im s|/(2 pi) of the root of s^2 M + K + (damper, branches and charge at s) [Hz], 0: it does not swing */
    double damping_ratio; /**< -Re s/|s| of that root [1]; NAN: it does not swing */
    double undamped;      /**< w/(2 pi) [Hz] */
    double edge_share;    /**< of what a small change of the voltage does to the disc edge at rest; of all modes they sum to 1 [1] */
    double edge_mass;     /**< mass that moves with the disc edge in this mode, 1/phi^2 there [kg]; NAN: the edge stays */
    dea_state state;      /**< of the equilibrium */
} dea_mode;

/** The film at one radius under a static voltage; at r_a that of the disc. Stresses are true ones, in force per deformed area. */
typedef struct dea_station {
    double radius;        /**< of the film at rest and 0 V, lambda_pre R [m] */
    double displacement;  /**< from there, outward [m] */
    double stretch[2];    /**< lambda_1 along the radius, lambda_2 along the hoop, pre-stretch included [1] */
    double thickness;     /**< of each layer, H/(lambda_1 lambda_2) [m] */
    double stress[2];     /**< of film and voltage together, lambda_a P_a - eps E^2 where electroded [Pa] */
    double field;         /**< true field U lambda_1 lambda_2/H where electroded, else 0 [V/m] */
    dea_state state;      /**< of the film here */
} dea_station;

/** Number of columns of a layout, and of those of a shape or a profile. */
enum { DEA_LAYOUT_COLUMNS = 16, DEA_SPREAD_COLUMNS = 8 };

/** How the result of one point of a study lies in memory: its rows, then its summary or its band. */
typedef struct dea_layout {
    dea_column columns[DEA_LAYOUT_COLUMNS]; /**< numeric columns, in order; the state column follows them */
    size_t column_count;
    size_t row_size;     /**< [bytes] */
    size_t state_offset; /**< of the dea_state in a row [bytes] */
    size_t rows;         /**< of one point, >= 1 */
    size_t point_size;   /**< rows and what stands behind them [bytes] */
    dea_column spread[DEA_SPREAD_COLUMNS]; /**< what each row tells over the radius: offsets in an entry, which is all doubles */
    size_t spread_count;                   /**< of these, 0: nothing */
    size_t spread_points;                  /**< radii; entries stand behind the rows and their figures, radius after radius of a row */
    size_t spread_offset;                  /**< of the first entry in a point [bytes] */
} dea_layout;

/** Appends a column. */
DEA_API void dea_layout_add(dea_layout *layout, dea_column column);
/** Appends to a layout that is else whole @p count numbers that each row tells at @p points radii. */
DEA_API void dea_layout_spread(dea_layout *layout, const dea_column *columns, size_t count, size_t points);
/** Layout of the scene's study: which columns depends on what the scene has (electrical port, optics). */
DEA_API dea_layout dea_layout_of(const dea_scene *scene);
/** Time of sample @p index of a transient, frequency of row @p index of an AC study. */
DEA_API double dea_layout_place(const dea_scene *scene, size_t index);
/** Row of a transient whose sample lies at a time, between two of them and past the last one too; not cut to those there are. */
DEA_API double dea_layout_index(const dea_scene *scene, double time);
/** Radius number @p index of what rows tell over the radius, that of the film at rest and 0 V [m]. */
DEA_API double dea_layout_radius(const dea_scene *scene, const dea_layout *layout, size_t index);
/** Entry of a row at a radius. */
DEA_API double *dea_layout_entry(const dea_layout *layout, const void *point, size_t row, size_t index);
/** Number at an offset of a row, or of anything else that columns tell of. */
DEA_API double dea_layout_number(const void *row, size_t offset);
/** State of a row. */
DEA_API dea_state dea_layout_state(const dea_layout *layout, const void *row);
/** Makes every row of a point `failed`. */
DEA_API void dea_layout_fail(const dea_scene *scene, const dea_layout *layout, void *point);
/** A summary without numbers. */
DEA_API dea_summary dea_summary_failed(void);
/** Summary of a transient's point. */
DEA_API dea_summary *dea_layout_summary(const dea_layout *layout, const void *point);
/** What a point of profiles is nearest to its limits by. */
DEA_API dea_weakest *dea_layout_weakest(const dea_layout *layout, const void *point);
/** Band of a frequency response's point. */
DEA_API dea_band *dea_layout_band(const dea_layout *layout, const void *point);

#ifdef __cplusplus
}
#endif
#endif
