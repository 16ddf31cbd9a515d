/* Each effect has a scene that calls for it and scenes that do not, and costs the latter nothing.
 *
 * Why this is hard: that an absent effect changes nothing can only be seen where it is present and has nothing to do. Strategy:
 * one scene, a stage with a thing on it, is baked with the thing of plain matt paint, with the thing as each effect would have
 * it, and with such a thing where no ray of the path comes. Packs are then opened up: the effect's bit is set in a pack that
 * has no use for it, with all that the loader wants of such a pack, and every frame must keep its bits; the bit is cleared in
 * the pack that has, and they must change. All on the device host, which compiles every effect into one program and reports
 * from the runtime's tables. */
#include "scene_lab.h"

#include "cost/effect_cost.h"
#include "cost/fit.h"
#include "pack/effects.h"
#include "open_pack.h"
#include "pack_sections.h"

enum { FRAMES = EFFECT_COST_FRAMES, MATERIALS = 3 };

/* A floor, a back wall, the thing: a block on the floor, and a vault under the floor, closed, with a second thing in it. */
static const char stage[] =
    "mtllib stage.mtl\n"
    "v -2 0 -2\nv 2 0 -2\nv 2 0 2\nv -2 0 2\nv -2 3 -2\nv 2 3 -2\n"
    "v -0.5 0 -0.5\nv 0.5 0 -0.5\nv 0.5 0 0.5\nv -0.5 0 0.5\nv -0.5 1 -0.5\nv 0.5 1 -0.5\nv 0.5 1 0.5\nv -0.5 1 0.5\n"
    "v -1 -2 -1\nv 1 -2 -1\nv 1 -2 1\nv -1 -2 1\nv -1 -1 -1\nv 1 -1 -1\nv 1 -1 1\nv -1 -1 1\n"
    "v -0.2 -1.5 0\nv 0.2 -1.5 0\nv 0 -1.2 0\n"
    "vn 0.6 0.6 0.52915\nvn -0.6 0.6 0.52915\nvn 0.6 0.6 -0.52915\nvn -0.6 0.6 -0.52915\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "usemtl stone\nf 4/1 3/2 2/3 1/4\nf 1/1 2/2 6/3 5/4\n"
    "f 15/1 16/2 17/3 18/4\nf 19/1 22/2 21/3 20/4\nf 15/1 19/2 20/3 16/4\nf 16/1 20/2 21/3 17/4\n"
    "f 17/1 21/2 22/3 18/4\nf 18/1 22/2 19/3 15/4\n"
    "usemtl thing\nf 14/1%s 13/2%s 12/3%s 11/4%s\nf 10/1 9/2 13/3 14/4\nf 8/1 7/2 11/3 12/4\n"
    "f 9/1 8/2 12/3 13/4\nf 7/1 10/2 14/3 11/4\n"
    "usemtl secret\nf 23/1 24/2 25/3\n";
static const char paint[] = "newmtl stone\nKd 0.6 0.5 0.4\nnewmtl thing\nKd 0.4 0.5 0.6\nnewmtl secret\nKd 0.5 0.5 0.5\n";

#define LAMP                                                                                                                   \
    "{ type = \"point\"; keys = ( { position = [0.9, 2.5, 0.6]; power = [50.0, 60.0, 70.0]; "                                  \
    "}, { time = 0.1; position = [1.2, 2.5, 0.6]; } ); }"

/* X(macro, lights, settings of `thing`, more of the scene, more of the quality block): scenes that call for the effects. */
#define SCENES(X)                                                                                                              \
    X(SPOT,                                                                                                                    \
      "{ type = \"spot\"; inner = 20.0; outer = 50.0; keys = ( { position = [0.9, 2.5, 0.6]; "                                 \
      "target = [0.0, 0.0, 0.0]; power = [50.0, 60.0, 70.0]; } ); }",                                                          \
      "", "", "")                                                                                                              \
    X(RANGE,                                                                                                                   \
      "{ type = \"point\"; range = 6.0; keys = ( { position = [0.9, 2.5, 0.6]; power = [50.0, 60.0, 70.0]; "                   \
      "} ); }",                                                                                                                \
      "", "", "")                                                                                                              \
    X(DIRECTIONAL,                                                                                                             \
      "{ type = \"directional\"; keys = ( { position = [1.0, 2.0, 1.0]; target = [0.0, 0.0, 0.0]; "                            \
      "irradiance = [3.0, 3.0, 2.0]; } ); }",                                                                                  \
      "", "", "")                                                                                                              \
    X(TEXTURES, LAMP, "texture = \"holes.tga\";", "", "")                                                                      \
    X(CUTOUT, LAMP, "texture = \"holes.tga\"; cutoff = 0.5;", "", "")                                                          \
    X(EMISSION, LAMP, "emission = [0.5, 0.4, 0.3]; area_light = false;", "", "")                                               \
    X(SPECULAR, LAMP, "specular = [0.3, 0.3, 0.3]; exponent = 40.0;", "", "")                                                  \
    X(GGX, LAMP, "specular = [0.3, 0.3, 0.3]; roughness = 0.3;", "", "")                                                       \
    X(NORMAL_MAPS, LAMP, "normal_map = \"holes.tga\";", "", "")                                                                \
    X(GLOSS, LAMP, "specular = [0.3, 0.3, 0.3]; roughness = 0.3;", "background = [0.3, 0.4, 0.5]; sky: { light = true; };",    \
      "sky_samples = 4; bounces = 1;")                                                                                         \
    X(MIRROR, LAMP, "kind = \"mirror\"; specular = [0.9, 0.9, 0.9];", "", "")                                                  \
    X(GLASS, LAMP, "kind = \"glass\"; ior = 1.5; absorption = [0.1, 0.2, 0.3];", "", "")                                       \
    X(CAUSTICS, LAMP, "kind = \"mirror\"; specular = [0.9, 0.9, 0.9];", "", "")                                                \
    X(AMBIENT, LAMP, "", "ambient = [0.05, 0.06, 0.07];", "")                                                                  \
    X(OCCLUSION, LAMP, "", "ambient = [0.5, 0.6, 0.7]; ambient_radius = 0.5;", "cache_error = 0.2;")                           \
    X(ANTIALIAS, LAMP, "", "", "antialias = 4;")                                                                               \
    X(AREA_LIGHTS, LAMP, "emission = [0.5, 0.4, 0.3]; area_light = true;", "", "light_samples = 4;")                           \
    X(SKY_LIGHT, LAMP, "", "background = [0.3, 0.4, 0.5]; sky: { light = true; };", "sky_samples = 4;")                        \
    X(SKY_IMAGE, LAMP, "", "sky: { image = \"sky.tga\"; light = false; };", "")

static const struct {
    const char *name;
    uint64_t effect;
    const char *lights, *thing, *scene, *quality;
} scenes[] = {
#define X(macro, lights, thing, scene, quality) {#macro, VIT_BIT(macro), lights, thing, scene, quality},
    SCENES(X)
#undef X
};
enum { SCENE_COUNT = sizeof scenes / sizeof scenes[0] };

/* Bakes the stage; what the baker says is then in the laboratory's out.txt. `secret`: the material of the vault's thing. */
static void bake(scene_lab *l, const char *lights, const char *thing, const char *secret, const char *more, const char *quality,
                 bool bent) {
    FILE *f = scene_lab_create(l, "stage.obj");
    (void)fprintf(f, stage, bent ? "/1" : "", bent ? "/2" : "", bent ? "/3" : "", bent ? "/4" : "");
    (void)fclose(f);
    f = scene_lab_create(l, "stage.mtl");
    (void)fputs(paint, f);
    (void)fclose(f);
    unsigned char holes[HOLES_BYTES];
    test_packs_holes(holes);
    f = scene_lab_create(l, "holes.tga");
    assert_int_equal(fwrite(holes, 1, sizeof holes, f), sizeof holes);
    (void)fclose(f);
    unsigned char picture[HOLES_HEADER + 16 * 8 * 4]; /* twice as wide as high */
    memcpy(picture, holes, HOLES_HEADER);
    picture[12] = 16;
    for (size_t i = HOLES_HEADER; i < sizeof picture; i++)
        picture[i] = (unsigned char)(i * 7);
    f = scene_lab_create(l, "sky.tga");
    assert_int_equal(fwrite(picture, 1, sizeof picture, f), sizeof picture);
    (void)fclose(f);
    f = scene_lab_create(l, "stage.cfg");
    (void)fprintf(
        f,
        "output: { width = 80; height = 64; frames = %d; };\nmeshes = ( { file = \"stage.obj\"; } );\n"
        "camera: { keys = ( { eye = [0.6, 1.6, 4.5]; target = [0.0, 0.8, 0.0]; fov = 45.0; } ); };\nlights = ( %s );\n"
        "materials = ( { name = \"thing\"; %s }, { name = \"secret\"; %s } );\n%s\n"
        "quality: { indirect = \"photons\"; photons = 1500; radius = 0.4; tile = 16; indirect_samples = 1; %s };\n",
        FRAMES, lights, thing, secret, more, quality);
    (void)fclose(f);
    scene_lab_bake(l, "stage.cfg", "--explain");
}

static void *load(scene_lab *l, size_t *size) {
    return read_file(scene_lab_path(l, "scene.vit"), size);
}

/* What --explain said of the effect. */
static const char *explanation(scene_lab *l, uint64_t effect) {
    static char line[EFFECTS_REASON + 64];
    FILE *f = fopen(scene_lab_path(l, "out.txt"), "r");
    bool found = false;
    assert_non_null(f);
    while (!found && fgets(line, sizeof line, f)) {
        char name[32] = "";
        (void)sscanf(line, " %31s", name);
        found = effects_named(name) == effect;
    }
    (void)fclose(f);
    return found ? line : "";
}

static bool explained(scene_lab *l, uint64_t effect, const char *text) {
    return strstr(explanation(l, effect), text) != NULL;
}

typedef struct played {
    uint64_t hash[FRAMES];
    vit_requirements need;
    vit_statistics stats; /* of the last frame, with work */
    long long units;      /* work units per frame, mean */
} played;

static played play(const void *bytes, size_t size) {
    open_pack p;
    played r;
    void *copy = aligned_alloc(64, (size + 63) / 64 * 64);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    pack_open_bytes(&p, copy, size, (vit_open_info){.device = VIT_DEVICE_HOST, .format = VIT_FORMAT_RGBA32F, .count_work = 1});
    uint64_t units = 0;
    for (uint32_t i = 0; i < FRAMES; i++) {
        r.hash[i] = pack_frame_hash(&p, i);
        r.stats = pack_stats(&p);
        const vit_statistics *s = &r.stats;
        units += fit_work_units(s->pass_work, s->pass_count, s->work_names, s->work_count);
    }
    r.units = (long long)(units / FRAMES);
    r.need = p.need;
    pack_close(&p);
    return r;
}

/* The pack with the effect in it and nothing for it to act on: data that the loader wants of such a pack are there and do
 * nothing. */
static played play_idle(const void *bytes, uint64_t effect) {
    static vit_light_sample dark[2 * VIT_PATTERNS];
    static vit_sky_texel texels[9];
    static vit_maps no_maps[MATERIALS];
    static const vit_cache_cell no_cell = {.key = VIT_CACHE_EMPTY};
    pack_sections sections = pack_sections_of(bytes);
    vit_scene s = *(const vit_scene *)sections.data[VIT_SECTION_META];
    vit_text why = {""};
    void *idle = NULL;
    size_t size;
    s.effects |= effect | (effect & (VIT_BIT(GGX) | VIT_BIT(GLOSS)) ? VIT_BIT(GGX) | VIT_BIT(SPECULAR) : 0);
    s.gloss_rays = effect == VIT_BIT(GLOSS) ? 4 : 0;
    s.effects |= effect == VIT_BIT(NORMAL_MAPS) ? VIT_BIT(TEXTURES) | VIT_BIT(SMOOTH) : 0;
    for (int i = 0; i < MATERIALS; i++)
        no_maps[i] = (vit_maps){.normal = VIT_NONE, .normal_scale = 1};
    sections.data[VIT_SECTION_MAPS] = no_maps;
    if (effect & (VIT_BIT(MIRROR) | VIT_BIT(GLASS)))
        s.chain = 8;
    if (effect == VIT_BIT(ANTIALIAS)) {
        s.copies = 4; /* at the pixels' centres, and so much contrast is only between black and white */
        s.contrast = 1.0f;
        for (int i = 1; i < 4; i++)
            s.offset[i][0] = 0.25f;
    }
    for (int i = 0; i < 2 * VIT_PATTERNS; i++) {
        dark[i] = (vit_light_sample){.position = {0, 1, 0}, .normal = {0, -1, 0}};
        dark[i].radius2 = effect == VIT_BIT(AREA_LIGHTS) ? 1.0f : 0.0f;
        if (effect == VIT_BIT(AREA_LIGHTS))
            dark[i].position[1] = 4.0f;
    }
    for (int i = 0; i < 9; i++)
        memcpy(texels[i].radiance, s.background, sizeof texels[i].radiance);
    if (effect == VIT_BIT(AREA_LIGHTS))
        s.area_samples = 2;
    if (effect == VIT_BIT(SKY_LIGHT))
        s.sky_samples = 2;
    if (effect == VIT_BIT(SKY_IMAGE))
        s.sky_size = 1;
    if (effect == VIT_BIT(OCCLUSION)) { /* of black light */
        s.effects |= VIT_BIT(AMBIENT);
        s.cache_cells = s.cache_probes = s.cache_levels = 1;
        s.ambient_radius = s.cache_step = 1.0f;
        sections.data[VIT_SECTION_CACH] = &no_cell;
    }
    sections.data[VIT_SECTION_META] = &s;
    sections.data[VIT_SECTION_EMIT] = dark;
    sections.data[VIT_SECTION_SKYT] = texels;
    if (pack_assemble(&sections, &idle, &size, &why) != VIT_OK)
        fail_msg("%s", why.text);
    const played r = play(idle, size);
    free(idle);
    return r;
}

static played play_without(const void *bytes, uint64_t effect) {
    const pack_sections sections = pack_sections_of(bytes);
    const uint64_t lamps = VIT_BIT(SPOT) | VIT_BIT(DIRECTIONAL) | VIT_BIT(RANGE); /* the scene's only light is such a one */
    vit_text why = {""};
    void *less = NULL;
    size_t size;
    if (effect_cost_without(&sections, effect | (effect & lamps ? VIT_BIT(LIGHTS) : 0), &less, &size, &why) != VIT_OK)
        fail_msg("%s", why.text);
    const played r = play(less, size);
    free(less);
    return r;
}

static void has_the_work_of(const char *name, const played *a, const played *b) {
    assert_int_equal(a->stats.pass_count, b->stats.pass_count);
    for (uint32_t p = 0; p < a->stats.pass_count; p++)
        for (uint32_t k = 0; k < a->stats.work_count; k++)
            if (a->stats.pass_work[p][k] != b->stats.pass_work[p][k])
                fail_msg("%s: %s of pass %s: %llu and %llu", name, a->stats.work_names[k], a->stats.pass_names[p],
                         (unsigned long long)a->stats.pass_work[p][k], (unsigned long long)b->stats.pass_work[p][k]);
}

static void has_the_tables_of(const char *name, const played *a, const played *b) {
    assert_int_equal(a->need.pass_count, b->need.pass_count);
    for (uint32_t i = 0; i < a->need.pass_count; i++)
        assert_string_equal(a->need.passes[i], b->need.passes[i]);
    assert_int_equal(a->need.buffer_count, b->need.buffer_count);
    for (uint32_t i = 0; i < a->need.buffer_count; i++) {
        assert_string_equal(a->need.buffers[i].name, b->need.buffers[i].name);
        if (a->need.buffers[i].bytes != b->need.buffers[i].bytes)
            fail_msg("%s: buffer %s: %llu and %llu bytes", name, a->need.buffers[i].name,
                     (unsigned long long)a->need.buffers[i].bytes, (unsigned long long)b->need.buffers[i].bytes);
    }
}

/* --explain's figures of an effect are the differences of the runtime's tables and counts. */
static void adds_what_is_explained(scene_lab *l, const char *name, uint64_t effect, const played *with, const played *without) {
    long long bytes = 0, work = 0;
    const int read = sscanf(explanation(l, effect), " %*s %lld %lld", &bytes, &work);
    if (!(effect & EFFECT_COST_MEASURED)) {
        assert_int_equal(read, 0);
        return;
    }
    if (read != 2 || bytes != (long long)(with->need.device_bytes - without->need.device_bytes))
        fail_msg("%s: --explain says %lld bytes, the runtime's tables %lld", name, bytes,
                 (long long)(with->need.device_bytes - without->need.device_bytes));
    if (work != with->units - without->units)
        fail_msg("%s: --explain says %lld work units, counted are %lld", name, work, with->units - without->units);
}

static void a_plain_scene_has_none_and_each_would_change_no_bit_of_it(void **state) {
    scene_lab *l = *state;
    size_t size;
    bake(l, LAMP, "", "", "", "", false);
    void *bytes = load(l, &size);
    const played plain = play(bytes, size);
    for (size_t i = 0; i < SCENE_COUNT; i++) {
        const uint64_t effect = scenes[i].effect;
        if (plain.need.effects & effect)
            fail_msg("the plain scene has the effect %s", scenes[i].name);
        if (!explained(l, effect, "not called for: would be if"))
            fail_msg("%s: --explain does not say that it is not called for", scenes[i].name);
        const played idle = play_idle(bytes, effect);
        assert_true(idle.need.effects & effect);
        for (uint32_t k = 0; k < FRAMES; k++)
            if (idle.hash[k] != plain.hash[k])
                fail_msg("%s: with nothing to act on it changes frame %u", scenes[i].name, k);
    }
    const played idle = play_idle(bytes, VIT_BIT(SMOOTH));
    assert_false(plain.need.effects & VIT_BIT(SMOOTH));
    assert_memory_equal(idle.hash, plain.hash, sizeof plain.hash);
    free(bytes);
}

static void each_is_called_for_by_its_scene_and_changes_it(void **state) {
    scene_lab *l = *state;
    for (size_t i = 0; i < SCENE_COUNT; i++) {
        const uint64_t effect = scenes[i].effect;
        size_t size;
        bake(l, scenes[i].lights, scenes[i].thing, "", scenes[i].scene, scenes[i].quality, false);
        void *bytes = load(l, &size);
        const played with = play(bytes, size), without = play_without(bytes, effect);
        if (!(with.need.effects & effect))
            fail_msg("%s: its scene does not have it", scenes[i].name);
        if (!explained(l, effect, "called for: ") || explained(l, effect, "not called for"))
            fail_msg("%s: --explain does not say that it is called for", scenes[i].name);
        if (scenes[i].thing[0] && effect != VIT_BIT(CUTOUT) && !explained(l, effect, "material 'thing' (10 triangles)"))
            fail_msg("%s: --explain does not name the material", scenes[i].name);
        for (uint32_t k = 0; k < FRAMES; k++)
            if (with.hash[k] == without.hash[k])
                fail_msg("%s: without it frame %u is the same", scenes[i].name, k);
        adds_what_is_explained(l, scenes[i].name, effect, &with, &without);
        free(bytes);
    }
}

/* A thing that no ray of the path reaches calls for nothing: tables and work are those of the plain scene. */
static void what_is_never_reached_is_not_called_for(void **state) {
    scene_lab *l = *state;
    static const uint64_t of_surfaces = VIT_BIT(TEXTURES) | VIT_BIT(EMISSION) | VIT_BIT(SPECULAR) | VIT_BIT(GGX) |
                                        VIT_BIT(NORMAL_MAPS) | VIT_BIT(MIRROR) | VIT_BIT(GLASS) | VIT_BIT(CAUSTICS);
    size_t size;
    bake(l, LAMP, "", "", "", "", false);
    void *bytes = load(l, &size);
    const played plain = play(bytes, size);
    free(bytes);
    for (size_t i = 0; i < SCENE_COUNT; i++) {
        if (!(scenes[i].effect & of_surfaces))
            continue;
        bake(l, LAMP, "", scenes[i].thing, "", "", false);
        bytes = load(l, &size);
        const played r = play(bytes, size);
        if (r.need.effects & scenes[i].effect)
            fail_msg("%s: is there, but nothing that it acts on is ever reached", scenes[i].name);
        if (!explained(l, scenes[i].effect, "never reached on the path: material 'secret' (1 triangle)"))
            fail_msg("%s: --explain does not say why it is not there", scenes[i].name);
        assert_memory_equal(r.hash, plain.hash, sizeof plain.hash);
        has_the_tables_of(scenes[i].name, &r, &plain);
        has_the_work_of(scenes[i].name, &r, &plain);
        free(bytes);
    }
}

static void bent_normals_call_for_smooth_ones(void **state) {
    scene_lab *l = *state;
    size_t size;
    bake(l, LAMP, "", "", "", "", true);
    void *bytes = load(l, &size);
    const played with = play(bytes, size), without = play_without(bytes, VIT_BIT(SMOOTH));
    assert_true(with.need.effects & VIT_BIT(SMOOTH));
    assert_true(explained(l, VIT_BIT(SMOOTH), "visible in all frames"));
    for (uint32_t k = 0; k < FRAMES; k++)
        assert_true(with.hash[k] != without.hash[k]);
    free(bytes);
}

/* The scene's `effects`: all, a list, names that are none. */
static void effects_can_be_forced_on_and_off(void **state) {
    scene_lab *l = *state;
    size_t size;
    bake(l, LAMP, "kind = \"mirror\"; specular = [0.9, 0.9, 0.9];", "", "", "", false);
    void *bytes = load(l, &size);
    const played automatic = play(bytes, size);
    free(bytes);
    bake(l, LAMP, "kind = \"mirror\"; specular = [0.9, 0.9, 0.9];", "", "effects = \"all\";", "", false);
    bytes = load(l, &size);
    const played all = play(bytes, size);
    free(bytes);
    assert_memory_equal(all.hash, automatic.hash, sizeof all.hash);
    assert_true(all.need.effects & VIT_BIT(GLASS) && all.need.effects & VIT_BIT(SPECULAR) &&
                all.need.effects & VIT_BIT(TEXTURES));
    assert_true(explained(l, VIT_BIT(GLASS), "forced on: nothing on the path calls for it"));
    bake(l, LAMP, "kind = \"mirror\"; specular = [0.9, 0.9, 0.9];", "", "effects = [\"glass\"];", "", false);
    bytes = load(l, &size);
    const played listed = play(bytes, size);
    free(bytes);
    assert_true(scene_lab_said(l, "warning: mirror is left out: material 'thing' (10 triangles), visible in all frames"));
    assert_false(scene_lab_said(l, "warning: glass"));
    assert_int_equal(listed.need.effects & EFFECTS_NAMED, VIT_BIT(GLASS));
    assert_true(memcmp(listed.hash, automatic.hash, sizeof listed.hash) != 0);
    assert_true(explained(l, VIT_BIT(MIRROR), "forced off: material 'thing' (10 triangles)"));
    bake(l, LAMP, "kind = \"mirror\"; specular = [0.9, 0.9, 0.9];", "", "effects = [];", "", false);
    bytes = load(l, &size);
    const played none = play(bytes, size);
    free(bytes);
    assert_int_equal(none.need.effects & EFFECTS_NAMED, 0);
    assert_true(scene_lab_said(l, "warning: mirror is left out: material 'thing' (10 triangles), visible in all frames"));
    assert_memory_equal(listed.hash, none.hash,
                        sizeof none.hash); /* a mirror that is left out is none for glass's passes either */
}

static void sources_that_are_left_out_give_no_photons(void **state) {
    scene_lab *l = *state;
    size_t size;
    bake(l, "", "emission = [9.0, 8.0, 7.0];", "", "effects = [];", "", false);
    void *bytes = load(l, &size);
    const played dark = play(bytes, size);
    free(bytes);
    assert_int_equal(dark.need.effects & (VIT_BIT(INDIRECT) | VIT_BIT(PHOTONS) | VIT_BIT(AREA_LIGHTS) | VIT_BIT(EMISSION)), 0);
    assert_true(scene_lab_said(l, "warning: area-lights is left out: material 'thing' (10 triangles)"));
}

static void cut_outs_that_are_left_out_are_warned_of(void **state) {
    scene_lab *l = *state;
    bake(l, LAMP, "texture = \"holes.tga\"; cutoff = 0.5;", "", "effects = [\"textures\"];", "", false);
    assert_true(scene_lab_said(l, "warning: cutout is left out: material 'thing' (10 triangles), visible in all frames"));
    bake(l, LAMP, "", "", "sky: { image = \"sky.tga\"; light = false; }; effects = [];", "", false);
    assert_true(scene_lab_said(l, "warning: sky-image is left out: the sky, visible in all frames"));
}

/* With gloss in the program a mirror that is left out is still matt, not a lobe of what it would reflect. */
static void a_mirror_that_is_left_out_does_not_shine(void **state) {
    scene_lab *l = *state;
    size_t size;
    uint64_t hash[2][FRAMES];
    for (int i = 0; i < 2; i++) {
        bake(l, LAMP, "kind = \"mirror\"; specular = [0.9, 0.9, 0.9];", "", i ? "effects = [\"specular\"];" : "effects = [];",
             "", false);
        void *bytes = load(l, &size);
        const played p = play(bytes, size);
        assert_int_equal(p.need.effects & EFFECTS_NAMED, i ? VIT_BIT(SPECULAR) : 0);
        memcpy(hash[i], p.hash, sizeof hash[i]);
        free(bytes);
    }
    assert_memory_equal(hash[0], hash[1], sizeof hash[0]);
}

/* Photons of a still light are traced while baking. */
static void caustics_of_still_lights_are_called_for_too(void **state) {
    scene_lab *l = *state;
    size_t size;
    bake(l, "{ type = \"point\"; keys = ( { position = [0.9, 2.5, 0.6]; power = [50.0, 60.0, 70.0]; } ); }",
         "kind = \"mirror\"; specular = [0.9, 0.9, 0.9];", "kind = \"glass\";", "", "", false);
    void *bytes = load(l, &size);
    const played with = play(bytes, size);
    free(bytes);
    assert_true(with.need.effects & VIT_BIT(CAUSTICS));
    assert_false(with.need.effects & (VIT_BIT(TRACED) | VIT_BIT(GLASS)));
    assert_true(explained(l, VIT_BIT(CAUSTICS), "called for: material 'thing' (10 triangles), met by photons"));
    assert_true(explained(l, VIT_BIT(GLASS), "never reached on the path: material 'secret'"));
}

static void mirrors_and_glass_are_left_out_one_by_one(void **state) {
    scene_lab *l = *state;
    size_t size;
    bake(l, LAMP, "kind = \"mirror\"; specular = [0.9, 0.9, 0.9]; }, { name = \"stone\"; kind = \"thin_glass\";", "",
         "background = [0.3, 0.4, 0.5];", "", false);
    void *bytes = load(l, &size);
    const played both = play(bytes, size), glass = play_without(bytes, VIT_BIT(MIRROR)),
                 mirror = play_without(bytes, VIT_BIT(GLASS)), none = play_without(bytes, VIT_BIT(MIRROR) | VIT_BIT(GLASS));
    for (uint32_t k = 0; k < FRAMES; k++) {
        const uint64_t hashes[] = {both.hash[k], glass.hash[k], mirror.hash[k], none.hash[k]};
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < i; j++)
                if (hashes[i] == hashes[j])
                    fail_msg("frame %u: %d and %d are the same", k, i, j);
    }
    adds_what_is_explained(l, "a mirror beside glass", VIT_BIT(MIRROR), &both, &glass);
    adds_what_is_explained(l, "glass beside a mirror", VIT_BIT(GLASS), &both, &mirror);
    const played direct = play_without(bytes, VIT_BIT(INDIRECT)), dark = play_without(bytes, VIT_BIT(LIGHTS));
    adds_what_is_explained(l, "indirect light by photons of a moving light", VIT_BIT(INDIRECT), &both, &direct);
    adds_what_is_explained(l, "the light", VIT_BIT(LIGHTS), &both, &dark);
    free(bytes);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plain_scene_has_none_and_each_would_change_no_bit_of_it),
        cmocka_unit_test(each_is_called_for_by_its_scene_and_changes_it),
        cmocka_unit_test(what_is_never_reached_is_not_called_for),
        cmocka_unit_test(bent_normals_call_for_smooth_ones),
        cmocka_unit_test(effects_can_be_forced_on_and_off),
        cmocka_unit_test(caustics_of_still_lights_are_called_for_too),
        cmocka_unit_test(sources_that_are_left_out_give_no_photons),
        cmocka_unit_test(cut_outs_that_are_left_out_are_warned_of),
        cmocka_unit_test(a_mirror_that_is_left_out_does_not_shine),
        cmocka_unit_test(mirrors_and_glass_are_left_out_one_by_one),
    };
    return cmocka_run_group_tests_name("effect scenes", tests, scene_lab_set_up, scene_lab_tear_down);
}
