/* An effect that the scene does not call for costs nothing: no buffer, no pass, no kernel.
 *
 * Why this is hard: what is not there cannot be looked at, and a table that is asked about itself agrees with itself. Strategy:
 * packs that differ in one effect are compared by what vit_require() says about them, against what that effect alone may add;
 * and what vit_require() says is held against what the library really asks of OpenCL, since this program is linked with --wrap
 * for the three calls that make and run things. Nothing is compiled either: the program's own list of kernels is read. */
#include "open_pack.h"
#include "vitrine_pack.h"

#include <CL/cl.h>

/* What the library asked of OpenCL. */
static struct {
    cl_program program;
    uint32_t kernels, buffers, enqueued;
    uint64_t bytes;
    cl_kernel made[VIT_MAX_PASSES];
    char names[VIT_MAX_PASSES][64];
    uint32_t runs[VIT_MAX_PASSES]; /* of each kernel */
    uint64_t order;                /* a hash of which kernels ran, in which order, with which sizes */
} asked;

cl_kernel __real_clCreateKernel(cl_program program, const char *name, cl_int *error);
cl_kernel __wrap_clCreateKernel(cl_program program, const char *name, cl_int *error);
cl_kernel __wrap_clCreateKernel(cl_program program, const char *name, cl_int *error) {
    asked.program = program;
    assert_in_range(asked.kernels, 0, VIT_MAX_PASSES - 1);
    cl_kernel made = __real_clCreateKernel(program, name, error);
    asked.made[asked.kernels] = made;
    (void)snprintf(asked.names[asked.kernels++], sizeof asked.names[0], "%s", name);
    return made;
}

cl_mem __real_clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void *host, cl_int *error);
cl_mem __wrap_clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void *host, cl_int *error);
cl_mem __wrap_clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void *host, cl_int *error) {
    asked.buffers++;
    asked.bytes += size;
    return __real_clCreateBuffer(context, flags, size, host, error);
}

cl_int __real_clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t *offset,
                                     const size_t *global, const size_t *local, cl_uint waits, const cl_event *wait,
                                     cl_event *event);
cl_int __wrap_clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t *offset,
                                     const size_t *global, const size_t *local, cl_uint waits, const cl_event *wait,
                                     cl_event *event);
cl_int __wrap_clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t *offset,
                                     const size_t *global, const size_t *local, cl_uint waits, const cl_event *wait,
                                     cl_event *event) {
    asked.enqueued++;
    for (uint32_t i = 0; i < asked.kernels; i++)
        if (asked.made[i] == kernel) {
            const uint64_t run[] = {asked.order, i, *global, *local};
            asked.runs[i]++;
            asked.order = vit_hash(run, sizeof run);
        }
    return __real_clEnqueueNDRangeKernel(queue, kernel, dimensions, offset, global, local, waits, wait, event);
}

static vit_requirements requirements(const char *name) {
    vit_requirements need;
    vit_text why = {""};
    size_t size;
    void *bytes = read_file(test_pack(name), &size);
    if (vit_require(&(vit_open_info){.pack = bytes, .pack_size = size}, &need, &why) != VIT_OK)
        fail_msg("%s: %s", name, why.text);
    free(bytes);
    return need;
}

static uint64_t bytes_of(const vit_requirements *need, const char *buffer) {
    for (uint32_t i = 0; i < need->buffer_count; i++)
        if (strcmp(need->buffers[i].name, buffer) == 0)
            return need->buffers[i].bytes;
    return 0;
}

static int has_pass(const vit_requirements *need, const char *pass) {
    for (uint32_t i = 0; i < need->pass_count; i++)
        if (strcmp(need->passes[i], pass) == 0)
            return 1;
    return 0;
}

/* Is `word` in the list, which has a space on each side of every word? */
static int is_among(const char *list, const char *word) {
    char spaced[80];
    (void)snprintf(spaced, sizeof spaced, " %s ", word);
    return strstr(list, spaced) != NULL;
}

/* The pack `with` has exactly these buffers and passes that `without` has not. */
static void adds(const char *with, const char *without, const char *buffers, const char *passes) {
    const vit_requirements a = requirements(with), b = requirements(without);
    for (uint32_t i = 0; i < a.buffer_count; i++) {
        const char *name = a.buffers[i].name;
        assert_true(a.buffers[i].bytes > 0);
        if ((bytes_of(&b, name) == 0) != is_among(buffers, name))
            fail_msg("buffer %s: is in %s, and in %s it has %llu bytes", name, with, without,
                     (unsigned long long)bytes_of(&b, name));
    }
    for (uint32_t i = 0; i < a.pass_count; i++)
        if (has_pass(&b, a.passes[i]) == is_among(passes, a.passes[i]))
            fail_msg("pass %s: is in %s, and in %s %d times", a.passes[i], with, without, has_pass(&b, a.passes[i]));
}

/* The same, and `without` has nothing of its own. */
static void only_adds(const char *with, const char *without, const char *buffers, const char *passes) {
    adds(with, without, buffers, passes);
    adds(without, with, " ", " ");
}

static void without_photons_four_passes_and_no_photon_buffer_are_left(void **state) {
    (void)state;
    const vit_requirements need = requirements("dark");
    static const char *const passes[] = {"visibility", "samples", "direct_light", "resolve"};
    assert_int_equal(need.pass_count, 4);
    for (uint32_t i = 0; i < 4; i++)
        assert_string_equal(need.passes[i], passes[i]);
    assert_int_equal(need.effects & vit_effects_upon(VIT_BIT(INDIRECT)), 0);
    static const char buffers[] = " scene cameras lights triangles attributes bvh materials hit_triangle hit_distance position "
                                  "normal albedo direct counters framebuffer ";
    for (uint32_t i = 0; i < need.buffer_count; i++)
        if (!is_among(buffers, need.buffers[i].name) || !is_among(" always lights ", need.buffers[i].effect))
            fail_msg("buffer %s, for %s", need.buffers[i].name, need.buffers[i].effect);
}

static void photons_add_their_own_buffers_and_leave_the_others_alone(void **state) {
    (void)state;
    const vit_requirements list = requirements("list"), dark = requirements("dark");
    uint64_t shared = 0, added = 0;
    for (uint32_t i = 0; i < list.buffer_count; i++) {
        const uint64_t there = bytes_of(&dark, list.buffers[i].name);
        if (there)
            assert_int_equal(there, list.buffers[i].bytes);
        *(there ? &shared : &added) += list.buffers[i].bytes;
        assert_int_equal(there == 0, is_among(" indirect photons traced-photons list ", list.buffers[i].effect));
    }
    assert_int_equal(shared, dark.device_bytes);
    assert_int_equal(shared + added, list.device_bytes);
}

static void a_list_has_no_buckets(void **state) {
    (void)state;
    adds("buckets", "list", " buckets ", " splat_buckets ");
    adds("list", "buckets", " ", " ");
    assert_true(bytes_of(&(vit_requirements[]){requirements("buckets")}[0], "list") <
                bytes_of(&(vit_requirements[]){requirements("list")}[0], "list"));
}

static void raw_buckets_differ_in_the_size_of_a_bucket_buffer_alone(void **state) {
    (void)state;
    const vit_requirements raw = requirements("raw"), smooth = requirements("buckets");
    only_adds("raw", "buckets", " ", " ");
    assert_int_equal(bytes_of(&raw, "buckets") * 8, bytes_of(&smooth, "buckets") * 54);
}

static void a_flattened_kernel_takes_no_buffer_and_no_pass(void **state) {
    (void)state;
    only_adds("flattened", "list", " ", " ");
}

static void light_at_fewer_samples_takes_the_place_of_the_estimate(void **state) {
    (void)state;
    const vit_requirements four = requirements("sparse"), sixteen = requirements("sparse-room"), all = requirements("room");
    adds("sparse", "list", " coarse flags ", " estimate_sparse interpolate estimate_rest ");
    adds("list", "sparse", " ", " estimate_all ");
    adds("sparse-buckets", "room-buckets", " coarse flags ", " estimate_sparse interpolate estimate_rest ");
    adds("room-buckets", "sparse-buckets", " ", " estimate_all ");
    assert_int_equal(bytes_of(&four, "coarse"), bytes_of(&four, "indirect") / 12 / 4 * 36);
    assert_int_equal(bytes_of(&sixteen, "coarse"), bytes_of(&sixteen, "indirect") / 12 / 16 * 36);
    assert_int_equal(bytes_of(&sixteen, "flags"), bytes_of(&all, "keys") / 16);
}

static void a_texture_filter_takes_no_buffer_and_no_pass(void **state) {
    (void)state;
    only_adds("nearest", "room", " ", " ");
    only_adds("trilinear", "room", " ", " ");
    assert_int_equal(requirements("room").effects & (VIT_BIT(NEAREST) | VIT_BIT(TRILINEAR)), 0);
    assert_true(requirements("nearest").effects & VIT_BIT(NEAREST));
    assert_true(requirements("trilinear").effects & VIT_BIT(TRILINEAR));
}

static void small_samples_halve_the_positions_and_nothing_else(void **state) {
    (void)state;
    const vit_requirements small = requirements("small"), plain = requirements("list");
    only_adds("small", "list", " ", " ");
    assert_int_equal(bytes_of(&small, "position") * 2, bytes_of(&plain, "position"));
}

static void zones_and_areas_add_their_cells_and_a_word_a_sample_each(void **state) {
    (void)state;
    const vit_requirements all = requirements("zones"), plain = requirements("room");
    only_adds("zones", "room", " sides cells accept inverse_area ", " ");
    only_adds("zones-alone", "room", " sides cells accept ", " ");
    only_adds("areas-alone", "room", " sides cells inverse_area ", " ");
    only_adds("sequence", "room", " ", " ");
    /* Buckets have no use for areas within zones: planner.h. */
    const vit_requirements buckets = requirements("zones-buckets"), open = requirements("areas-buckets");
    assert_int_equal(bytes_of(&buckets, "inverse_area"), 0);
    assert_true(bytes_of(&buckets, "accept") > 0 && bytes_of(&open, "inverse_area") > 0);
    assert_int_equal(bytes_of(&all, "accept"), bytes_of(&plain, "keys"));
    assert_int_equal(bytes_of(&all, "inverse_area"), bytes_of(&plain, "keys"));
    assert_int_equal(bytes_of(&all, "sides"), bytes_of(&plain, "triangles") / sizeof(vit_triangle) * 2 * sizeof(vit_u32));
    assert_int_equal(plain.effects & (VIT_BIT(ZONES) | VIT_BIT(AREA) | VIT_BIT(SEQUENCE)), 0);
}

static void still_lights_have_no_pass_that_traces_photons(void **state) {
    (void)state;
    only_adds("room", "still", " ", " photon_paths ");
}

#define OF_RECEIVERS " sides receiver_cells receivers "
#define OF_RELIGHT " basis_groups basis_words basis_coefficients basis_frames relit "

/* Nothing of photons is left, and what both have is the same. */
static void baked_irradiance_takes_the_photons_place(void **state) {
    (void)state;
    const vit_requirements basis = requirements("basis"), photons = requirements("room");
    adds("basis", "room", OF_RECEIVERS OF_RELIGHT, " relight ");
    for (uint32_t i = 0; i < photons.buffer_count; i++) {
        const uint64_t there = bytes_of(&basis, photons.buffers[i].name);
        assert_int_equal(there == 0, is_among(" photons traced-photons list ", photons.buffers[i].effect));
        assert_true(there == 0 || there == photons.buffers[i].bytes);
    }
    for (uint32_t i = 0; i < photons.pass_count; i++)
        assert_int_equal(has_pass(&basis, photons.passes[i]),
                         is_among(" visibility samples direct_light resolve ", photons.passes[i]));
    assert_int_equal(basis.effects & vit_effects_upon(VIT_BIT(PHOTONS)), 0);
    assert_int_equal(bytes_of(&basis, "relit"), bytes_of(&basis, "receivers"));
    only_adds("basis-16", "basis", " ", " "); /* every sample has its own light */
    assert_int_equal(requirements("basis-16").effects & vit_effects_upon(VIT_BIT(SPARSE)), 0);
}

/* A table instead of sides, cells and splits, and a pass that looks it up. */
static void receivers_at_points_have_a_table_and_a_pass(void **state) {
    (void)state;
    const vit_requirements points = requirements("points"), cells = requirements("basis");
    adds("points", "basis", " ", " point_light ");
    adds("basis", "points", " sides receiver_splits ", " ");
    only_adds("points", "points-still", OF_RELIGHT, " relight ");
    assert_int_equal(points.effects, cells.effects | VIT_BIT(POINTS));
    assert_int_equal(bytes_of(&points, "receiver_cells") & (bytes_of(&points, "receiver_cells") - 1), 0);
}

static void still_lights_need_no_basis_and_no_relight(void **state) {
    (void)state;
    only_adds("basis", "basis-still", OF_RELIGHT, " relight ");
    assert_int_equal(requirements("basis-still").effects & VIT_BIT(RELIGHT), 0);
}

#define OF_PATCHES " patches patch_points gather_rows gather_words looked_up radiosity "
#define OF_TRANSFER " transfer sums reflected "

/* Receivers are the basis's; a second reflection has its own buffers and passes, and so has a rank. */
static void live_radiosity_takes_the_place_of_the_basis(void **state) {
    (void)state;
    const vit_requirements live = requirements("live"), once = requirements("live-once");
    adds("live", "basis", OF_PATCHES OF_TRANSFER " projected mixed ",
         " patch_light patch_mean transfer_project transfer_mix transfer_partial transfer_sum patch_reflect gather_patches ");
    adds("basis", "live", " basis_groups basis_words basis_coefficients basis_frames ", " relight ");
    only_adds("live", "live-once", OF_TRANSFER " projected mixed ",
              " transfer_project transfer_mix transfer_partial transfer_sum patch_reflect ");
    assert_int_equal(bytes_of(&live, "relit"), bytes_of(&live, "receivers"));
    assert_int_equal(once.effects & (VIT_BIT(TRANSFER) | VIT_BIT(LOW_RANK)), 0);
    assert_int_equal(live.effects & vit_effects_upon(VIT_BIT(BASIS)), 0);
    assert_int_equal(requirements("live-33x47").effects & VIT_BIT(LOW_RANK), 0); /* BC1 has none */
}

static void still_lights_are_baked_whatever_is_live(void **state) {
    (void)state;
    only_adds("live-still", "basis-still", " ", " ");
    only_adds("basis-still", "live-still", " ", " ");
}

static void photons_have_nothing_of_baked_irradiance(void **state) {
    (void)state;
    static const char *const packs[] = {"list", "room", "zones", "sparse-buckets", "still", "dark", "lamp", "shine"};
    for (size_t k = 0; k < sizeof packs / sizeof packs[0]; k++) {
        const vit_requirements need = requirements(packs[k]);
        assert_int_equal(need.effects & (vit_effects_upon(VIT_BIT(BASIS)) | vit_effects_upon(VIT_BIT(RADIOSITY))), 0);
        assert_false(has_pass(&need, "relight") || has_pass(&need, "gather_patches"));
        for (uint32_t i = 0; i < need.buffer_count; i++)
            assert_false(is_among(" basis relight radiosity transfer low-rank ", need.buffers[i].effect));
    }
}

static void a_scene_without_lights_has_neither_lights_nor_photons(void **state) {
    (void)state;
    const vit_requirements need = requirements("lamp");
    assert_int_equal(bytes_of(&need, "lights"), 0);
    assert_int_equal(need.pass_count, 3);
    assert_false(has_pass(&need, "direct_light"));
    assert_int_equal(need.effects & (VIT_BIT(LIGHTS) | vit_effects_upon(VIT_BIT(INDIRECT))), 0);
    assert_true(need.effects & VIT_BIT(EMISSION));
}

static void a_scene_without_textures_has_no_atlas(void **state) {
    (void)state;
    const vit_requirements plain = requirements("list"), textured = requirements("room");
    static const char *const buffers[] = {"textures", "mips", "texels"};
    for (size_t i = 0; i < 3; i++) {
        assert_int_equal(bytes_of(&plain, buffers[i]), 0);
        assert_true(bytes_of(&textured, buffers[i]) > 0);
    }
    assert_int_equal(plain.effects & (VIT_BIT(TEXTURES) | VIT_BIT(CUTOUT) | VIT_BIT(EMISSION)), 0);
    assert_true(textured.effects & VIT_BIT(CUTOUT));
}

/* All kernels that the program holds, with a space on each side of each. */
static void names_of_program(char *text, size_t size) {
    text[0] = ' ';
    assert_int_equal(clGetProgramInfo(asked.program, CL_PROGRAM_KERNEL_NAMES, size - 2, text + 1, NULL), CL_SUCCESS);
    (void)strcat(text, " ");
    for (char *c = text; *c; c++)
        *c = *c == ';' ? ' ' : *c;
}

static void open_and_play_one(const char *name, vit_view view) {
    open_pack p;
    char compiled[4096];
    memset(&asked, 0, sizeof asked);
    pack_open(&p, name, (vit_open_info){.view = view});
    assert_int_equal(asked.buffers, p.need.buffer_count);
    assert_int_equal(asked.bytes, p.need.device_bytes);
    assert_int_equal(asked.kernels, p.need.pass_count);
    names_of_program(compiled, sizeof compiled);
    size_t words = 0;
    for (const char *c = compiled + 1; *c; c++)
        words += *c == ' ';
    for (uint32_t i = 0; i < p.need.pass_count; i++) {
        assert_string_equal(asked.names[i], p.need.passes[i]);
        assert_true(is_among(compiled, p.need.passes[i]));
    }
    if (words != p.need.pass_count)
        fail_msg("%s: %u passes, but these kernels were compiled:%s", name, p.need.pass_count, compiled);
    const uint64_t opening =
        asked.order; /* it has run each kernel already, in the sizes of the frame: nothing is left to compile */
    memset(asked.runs, 0, sizeof asked.runs);
    asked.enqueued = 0;
    asked.order = 0;
    pack_frame(&p, 0);
    assert_int_equal(asked.order, opening);
    for (uint32_t i = 0; i < asked.kernels; i++)
        assert_in_range(asked.runs[i], 0, VIT_MAX_LEVELS * 4); /* two copies, two layers */
    for (uint32_t i = 0, all = 0; i < asked.kernels; i++) {
        all += asked.runs[i];
        assert_true(i + 1 < asked.kernels || all == asked.enqueued);
    }
    assert_int_equal(asked.buffers, p.need.buffer_count); /* a frame makes nothing */
    assert_int_equal(asked.kernels, p.need.pass_count);
    pack_close(&p);
}

static void what_is_made_and_compiled_is_what_was_required_and_no_more(void **state) {
    (void)state;
    static const char *const packs[] = {"list",  "buckets", "raw",         "dark",           "room",       "still",
                                        "lamp",  "sparse",  "sparse-room", "sparse-buckets", "small",      "small-sparse",
                                        "shine", "basis",   "basis-still", "basis-16",       "basis-shine"};
    for (size_t i = 0; i < sizeof packs / sizeof packs[0]; i++)
        open_and_play_one(packs[i], VIT_VIEW_final);
}

static void the_view_of_photons_alone_pays_for_its_dots(void **state) {
    (void)state;
    open_and_play_one("list", VIT_VIEW_photons);
    assert_true(strcmp(asked.names[asked.kernels - 3], "photon_dots") == 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_photons_four_passes_and_no_photon_buffer_are_left),
        cmocka_unit_test(photons_add_their_own_buffers_and_leave_the_others_alone),
        cmocka_unit_test(a_list_has_no_buckets),
        cmocka_unit_test(raw_buckets_differ_in_the_size_of_a_bucket_buffer_alone),
        cmocka_unit_test(a_flattened_kernel_takes_no_buffer_and_no_pass),
        cmocka_unit_test(light_at_fewer_samples_takes_the_place_of_the_estimate),
        cmocka_unit_test(a_texture_filter_takes_no_buffer_and_no_pass),
        cmocka_unit_test(small_samples_halve_the_positions_and_nothing_else),
        cmocka_unit_test(zones_and_areas_add_their_cells_and_a_word_a_sample_each),
        cmocka_unit_test(still_lights_have_no_pass_that_traces_photons),
        cmocka_unit_test(baked_irradiance_takes_the_photons_place),
        cmocka_unit_test(receivers_at_points_have_a_table_and_a_pass),
        cmocka_unit_test(still_lights_need_no_basis_and_no_relight),
        cmocka_unit_test(live_radiosity_takes_the_place_of_the_basis),
        cmocka_unit_test(still_lights_are_baked_whatever_is_live),
        cmocka_unit_test(photons_have_nothing_of_baked_irradiance),
        cmocka_unit_test(a_scene_without_lights_has_neither_lights_nor_photons),
        cmocka_unit_test(a_scene_without_textures_has_no_atlas),
        cmocka_unit_test(what_is_made_and_compiled_is_what_was_required_and_no_more),
        cmocka_unit_test(the_view_of_photons_alone_pays_for_its_dots),
    };
    return cmocka_run_group_tests_name("effects", tests, NULL, NULL);
}
