/* guiding_tree.c: where in the unit cube of a light's numbers photon paths are worth most: a binary tree of boxes, each with
 * its share of the paths. What a photon carries is divided by the density of paths in its box, so nothing is left out or
 * counted twice, wherever the paths go. */
#ifndef VIT_BAKE_GUIDE_H
#define VIT_BAKE_GUIDE_H

#include <stdbool.h>
#include <stdint.h>

#define GUIDING_DIMENSIONS 6 /* at most: numbers of a path's start and of its first reflection */
#define GUIDING_EVENLY                                                                                                         \
    0.2f /* of the paths go evenly everywhere, so that no photon carries more than 1 / 0.2 of what it would                    \
          */
#define GUIDING_NODES 131072u /* at most */

/* A path that was found to be worth something. */
typedef struct guiding_tree_sample {
    float at[GUIDING_DIMENSIONS];
    float weight;
} guiding_tree_sample;

typedef struct guiding_tree_node {
    float left;         /* share of its paths in the half of smaller numbers */
    uint32_t dimension; /* that is halved; VIT_NONE: a leaf */
    uint32_t right;     /* node of the other half; the left one follows its parent */
} guiding_tree_node;

typedef struct guiding_tree {
    guiding_tree_node *nodes; /* NULL: none */
    uint32_t count;
    double
        gain; /* density of the tree's paths where they are worth something, on average: how many even paths one stands for */
} guiding_tree;

/* Of samples in the first `dimensions`; their order changes, the tree depends on their order before. Without a sample that
 * weighs anything the tree is empty. False: out of memory. */
bool guiding_tree_build(guiding_tree_sample *samples, uint32_t count, uint32_t dimensions, guiding_tree *out);
void guiding_tree_free(guiding_tree *g);

/* Path i of `paths`: its numbers, each in [0, 1), and the density of paths there over that of even ones. number: seeds its
 * random numbers. */
float guiding_tree_point(const guiding_tree *g, uint32_t paths, uint32_t i, uint32_t number, float at[GUIDING_DIMENSIONS]);

#endif
