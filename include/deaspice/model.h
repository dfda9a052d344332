/** @file model.h
 * The static models, from the cheapest to the truth, behind one table.
 */
#ifndef DEASPICE_MODEL_H
#define DEASPICE_MODEL_H

#include "deaspice/result.h"
#include "deaspice/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A second film on the same frame, joined to the first at r_a by a rigid ring: u is the displacement of both edges. */
typedef struct dea_second {
    bool there;
    dea_kind kind;
    dea_film film;
    double film_thickness; /**< of all its layers together [m] */
    double layers;         /**< of its stack [1] */
    double voltage;        /**< across it [V] */
} dea_second;

/** One static point: film, geometry and the voltage across the film. A stack of n films of thickness H is one film of thickness
 * n H and n^2 times the permittivity: its pressure eps (U/H)^2 stays that of one layer, stiffness, force, mass and capacitance
 * are n times those. */
typedef struct dea_point {
    dea_film film;
    dea_kind kind;
    double frame_radius;   /**< r [m] */
    double coverage;       /**< B [1] */
    double film_thickness; /**< H, of all layers together [m] */
    double layers;         /**< of the stack [1]: the field is layers U/H */
    double voltage;        /**< U across the film [V] */
    double focal_length;   /**< of a lens at rest [m], NAN: no optics */
    double refractive_index; /**< of its liquid [1] */
    double load;             /**< stiffness of linear springs between edge and frame [N/m], 0: none */
    double force;            /**< that something else exerts on the edge, outward [N], 0: none */
    dea_edge_load springs[DEA_LOADS]; /**< the others, spring_count of them */
    size_t spring_count;
    dea_second second;       /**< the other film on the edge */
    double skin_share;       /**< t/H of the electrodes' skin [1], 0: there is none */
    dea_film skin;           /**< the skin at rest, not pre-stretched; set where there is one */
} dea_point;

/** Computes the film of a scene. */
DEA_API void dea_film_prepare(const dea_scene *scene, dea_film *film);
/** Sets geometry and voltage of @p point from the scene; its film stays as it is. */
DEA_API void dea_point_place(const dea_scene *scene, dea_point *point);
/** What the loads of a scene add up to. */
DEA_API dea_edge_terms dea_scene_edge(const dea_scene *scene);
/** Number of a load by the name of its kind in the table, to be set; NULL if there is none. */
DEA_API double *dea_scene_load(dea_scene *scene, const char *name);
/** Leaves a scene with no load. */
DEA_API void dea_scene_unload(dea_scene *scene);
/** True where anything but its film acts on the edge of a scene at this place of its axes: only models with an edge can do it. */
DEA_API bool dea_scene_is_loaded(const dea_scene *scene);
/** True where a steady force or a second film moves the edge of a scene without its voltage, whatever the place of its axes. */
DEA_API bool dea_scene_is_pulled(const dea_scene *scene);
/** True where all numbers of the point are in their ranges (a grid can hold a corner that is not). */
DEA_API bool dea_point_valid(const dea_point *point);

/** A linear network about rest: m u'' + r u' + (stiffness + beside + softening U^2) u + branches = force U^2, with the film's capacitance
 * C0 + C1 u + C2 u^2/2. One half of dC/du is force - softening u (physics: F_DEA = U^2/2 dC/du). */
typedef struct dea_linear {
    double stiffness;      /**< long-term, of all passive springs [N/m] */
    double beside;         /**< of what is elastic beside the film: it neither damps nor relaxes [N/m] */
    double softening;      /**< negative where the voltage softens [N/m/V^2] */
    double force;          /**< outward [N/V^2] */
    double capacitance[3]; /**< C0 [F], C1 [F/m], C2 [F/m^2] */
} dea_linear;

struct dea_network;
struct dea_symbols;
struct dea_hold;

/** Stretches along the radius and along the hoop, pre-stretch included [1]. */
typedef struct dea_stretches {
    double radial, hoop;
} dea_stretches;

/** A model as a subcircuit of circuits. */
typedef struct dea_model_part {
    const char *ending; /**< of the name of the part */
    const char *meaning;
    bool modulus;   /**< it takes an operating modulus */
    double stress;  /**< unit in which it counts stresses and moduli [Pa] */
    double tension; /**< what makes its tensions numbers of size 1: they are stretches, or stresses [Pa] */
} dea_model_part;

/** A static model. */
typedef struct dea_model {
    const char *name;       /**< e.g. "lumped" */
    const char *equation;   /**< e.g. "Eqs. 19-23" */
    const char *leaves_out; /**< what it neglects */
    bool lens;              /**< can do a lens too */
    bool edge;              /**< its film has an edge at r_a, onto which loads act */
    /** The model's own equations (engine `direct`); fills every field of @p row. @p accuracy is what the user wants. */
    void (*solve)(const dea_point *point, double accuracy, dea_row *row);
    /** The same for @p count points of one film, sooner: each row has the digits of solve(). NULL: one after the other. */
    void (*solve_many)(const dea_point *points, size_t count, double accuracy, dea_row *rows);
    /** What the film does at an edge that is held at @p strain, without loads; false where there is no such film. Where `edge` is
     * true. */
    bool (*hold)(const dea_point *point, double strain, struct dea_hold *hold);
    /** Adds its elements and limits to a network in displacement form; NULL where the model is not a network. */
    void (*network)(const struct dea_symbols *symbols, struct dea_network *network);
    /** Coefficients of the linear network (engine `direct` in transients); NULL where the network is not linear. */
    void (*linear)(const dea_point *point, dea_linear *linear);
    /** Stretches of the annulus of a film in equilibrium, whose disc edge is strained by @p strain, at @p count places
     * x = ln(R/R_a) >= 0 that do not fall; false where there is no such film. NULL where the model has no annulus with two stretches. */
    bool (*along)(const dea_point *point, double strain, size_t count, const double *x, dea_stretches *stretches);
    /** Can do transients and frequency responses. */
    bool dynamic;
    /** It is the boundary value problem of the axisymmetric membrane along the radius. */
    bool membrane;
    /** Of one node, for what is asked of one alone; NULL: the model itself. */
    const struct dea_model *stand_in;
    /** NULL: it is no part. */
    const dea_model_part *part;
} dea_model;

/** What solving a model takes, from the cheapest up. */
typedef enum dea_form {
    DEA_FORM_CLOSED,       /**< a closed form that is no network */
    DEA_FORM_LINEAR,       /**< a network of linear springs */
    DEA_FORM_HYPERELASTIC, /**< a network with others */
    DEA_FORM_MEMBRANE,     /**< a boundary value problem */
    DEA_FORMS
} dea_form;

/** The static row of a valid point: solve(), or where a force, a spring that is not linear or a second film acts on the edge the equilibrium that is connected to
 * rest: first those grow, then the voltage of the film (src/model/loaded.c). */
DEA_API void dea_model_solve(const dea_model *model, const dea_point *point, double accuracy, dea_row *row);

/** What a valid point does at an edge that something holds at a displacement [m]: `force` of the row is what the actuator exerts on
 * that, outward, loads and a second film included; strain and displacement are those that are held. The row is pull-in where no film
 * is so, failed where the edge is not between centre and frame. */
DEA_API void dea_model_hold(const dea_model *model, const dea_point *point, double displacement, dea_row *row);

/** Form of a model. */
DEA_API dea_form dea_model_form(const dea_model *model);

/** Number of models. */
DEA_API size_t dea_model_count(void);
/** Model number @p index from the cheapest up, NULL past the end. The library owns it. */
DEA_API const dea_model *dea_model_at(size_t index);
/** Model by name, NULL if there is none. */
DEA_API const dea_model *dea_model_find(const char *name);

/** Resistance between source and film [Ohm], NAN: none. That of the drive, and what the electrodes' sheets are as one resistance
 * (see dea_sheet_share()) where they have one. */
DEA_API double dea_series_resistance(const dea_scene *scene);
/** A sheet of 1 Ohm per square on the electroded region, fed from its outer rim, as one resistance [1]: the charge that flows in is
 * spread evenly, so that I^2 R = int_a^b I(r)^2/(2 pi r) dr with I(r) = I (r^2 - a^2)/(b^2 - a^2). 1/(8 pi) of a disc; of the
 * annulus of a lens [x (1 - 3 B^2)/4 - B^4 ln B]/(2 pi x^2) with x = 1 - B^2. @p layers films between layers + 1 sheets, the inner
 * ones of which feed two: (4 layers - 2)/layers^2 times that. */
DEA_API double dea_sheet_share(dea_kind kind, double coverage, double layers);
/** Mass of the electrodes per area of pre-stretched film [kg/m^2], 0: none. */
DEA_API double dea_electrode_mass(const dea_scene *scene);
/** Mass of film, electrodes, load and second film that moves with the disc edge [kg], 0 without density: Rayleigh with the shape of Lame's solution,
 * the electrodes' mass per area counted over the pre-stretched film (physics: section 5). */
DEA_API double dea_point_mass(const dea_scene *scene, const dea_point *point);

/** First in-plane radial resonance of the exact membrane at rest, undamped and relaxed, with what dea_point_mass() counts [Hz]; NAN
 * without density, where the film has no stiffness, and with a skin or a load (physics: section 5, with electrodes). */
DEA_API double dea_point_resonance(const dea_scene *scene, const dea_point *point);

/** Focal length [m] of a plano-convex cap of liquid of fixed volume, V = pi h (3 a^2 + h^2)/6, over an aperture of radius
 * @p radius [m] at rest that is strained by @p strain [1]; @p rest is the focal length at strain 0 [m]. NAN where no cap has that:
 * its radius of curvature rest (n - 1) would be less than @p radius (physics: section 5, lens optics). */
DEA_API double dea_lens_focal_length(double rest, double refractive_index, double radius, double strain);

#ifdef __cplusplus
}
#endif
#endif
