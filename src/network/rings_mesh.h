/* How many nodes a moving membrane wants. Every kink of the voltage sends a wave out. Where damper and charging smooth it over more
 * than the time that it takes between two nodes, every node more cuts the error of the mesh by one factor; else it falls with a
 * power of their number. */
#ifndef DEA_RINGS_MESH_H
#define DEA_RINGS_MESH_H

#include "network/membrane.h"

/* Nodes that tell the film at rest, and its first mode, to round-off; around a small disc they lie evenly in ln R. */
dea_rings_mesh dea_rings_usual_mesh(const dea_scene *scene);
/* The mesh of a scene for so many nodes an element, on average. */
dea_rings_mesh dea_rings_mesh_of(const dea_scene *scene, double nodes);
/* True where no mesh makes the film smooth: its error falls with a power of the nodes at best. */
bool dea_rings_stays_rough(const dea_scene *scene, const dea_model *model);
/* Nodes of an element for a first run. */
double dea_rings_first_nodes(double accuracy);
/* The same of a film with mass whose damper is known. */
double dea_rings_foreseen_nodes(const dea_membrane *membrane, const dea_membrane_rest *rest, double accuracy);
/* Nodes for the run after that with @p nodes; and what the error of the finer of both is taken for, over their difference: where
 * the film is not smooth the errors of both are alike. */
double dea_rings_more_nodes(const dea_membrane *membrane, const dea_membrane_rest *rest, double nodes);
double dea_rings_mesh_trust(const dea_membrane *membrane, const dea_membrane_rest *rest, double nodes);

/* The mesh after one: of so many more nodes that neither element stays as it is. False where an element has all that it may. */
bool dea_rings_finer_mesh(const dea_scene *scene, const dea_membrane *membrane, const dea_membrane_rest *rest, double *nodes,
                          dea_rings_mesh *mesh);

#endif
