/* The pass node_bounds: boxes of the inner nodes, level by level from the clusters up. METHODS.md, "Node hierarchy". */

/* Nodes of a level are numbered in a row: first of level + 1 is where the children of level's first mask word begin. */
static inline uint level_begin(global const vit_scene *scene, global const uint *prefix, uint level) {
    return level == 0 ? 0u : prefix[scene->level_first[level - 1]];
}

static inline uint level_end(global const vit_scene *scene, global const uint *prefix, global const uint *counters, uint level,
                             uint max_nodes) {
    uint end = level == scene->levels ? counters[VIT_COUNTER_nodes] : level_begin(scene, prefix, level + 1);
    return min(end, max_nodes);
}

#if VIT_WITH(PHOTONS)
kernel void node_bounds(global const vit_scene *scene, uint max_nodes, uint level, global const uint *prefix,
                        global const uint *node_first, global const uint *node_count, global int *bounds,
                        global const uint *counters) {
    uint node = level_begin(scene, prefix, level) + (uint)get_global_id(0);
    if (node >= level_end(scene, prefix, counters, level, max_nodes))
        return;
    uint first = node_first[node], count = node_count[node];
    for (uint k = 0; k < 12; k++) {
        global int *plane = VIT_PLANE(bounds, k, max_nodes);
        int least = (k % 6) < 3, v = least ? 0x7fffffff : (int)0x80000000;
        for (uint i = 0; i < count; i++)
            v = least ? min(v, plane[first + i]) : max(v, plane[first + i]);
        plane[node] = v;
    }
    if (!VIT_EFFECT_ZONES)
        return;
    global int *zones = VIT_PLANE(bounds, 12, max_nodes);
    int accepted = 0;
    for (uint i = 0; i < count; i++)
        accepted |= zones[first + i];
    zones[node] = accepted;
}
#endif
