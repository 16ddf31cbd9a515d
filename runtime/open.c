/* vit_require, vit_open, vit_close: from a pack to everything that its frames need. */
#include "byte_order.h"
#include "fail.h"
#include "vit.h"
#include <string.h>

#define MOST_PITCH 65536u /* pixels: offsets in the largest picture stay within 32 bits, signed */

static vit_status check_options(const vit_open_info *info, vit_text *why) {
    const char *bad = NULL;
    if (info->lanes != 0 && info->lanes != 1 && info->lanes != 8 && info->lanes != 16)
        bad = "lanes must be 0, 1, 8 or 16";
    else if (info->group > 256 || (info->group & (info->group - 1)) != 0)
        bad = "group must be 0 or a power of two up to 256";
    else if (info->threads > 256)
        bad = "threads must be 0 to 256";
    else if ((unsigned)info->format >= VIT_FORMAT_COUNT)
        bad = "no such format";
    else if ((unsigned)info->view >= VIT_VIEW_COUNT)
        bad = "no such view";
    else if (info->max_nodes > 1u << 26 || info->max_list > 1u << 28)
        bad = "max_nodes is at most 2^26, max_list 2^28";
    else if ((uintptr_t)info->framebuffer % 64 != 0)
        bad = "the framebuffer must be aligned to 64 bytes";
    if (!bad)
        return VIT_OK;
    return vit_fail(why, VIT_USAGE, "%s", bad);
}

/* The caller's memory for frames: whole pixels a row, none beyond its end. */
static vit_status check_framebuffer(const vit_open_info *info, const vit_scene *s, vit_text *why) {
    const size_t pixel = vit_format_bytes(info->format), row = s->width * pixel,
                 pitch = info->framebuffer_pitch ? info->framebuffer_pitch : row;
    const size_t most = pixel * MOST_PITCH;
    if (!info->framebuffer)
        return VIT_OK;
    if (pitch < row || pitch > most || pitch % pixel != 0)
        return vit_fail(why, VIT_USAGE, "framebuffer_pitch must be %zu to %zu bytes, in pixels of %zu, got %zu", row, most,
                        pixel, pitch);
    const uint64_t need = (uint64_t)pitch * (s->height - 1) + row;
    if (info->framebuffer_size == 0 || info->framebuffer_size >= need)
        return VIT_OK;
    return vit_fail(why, VIT_USAGE, "framebuffer_size: %u rows %zu bytes apart need %llu bytes, there are %zu", s->height,
                    pitch, (unsigned long long)need, info->framebuffer_size);
}

static vit_launch launch_of(const vit_open_info *info, const vit_scene *s) {
    vit_launch l = {
        .effects = s->effects, .max_nodes = s->max_nodes, .max_list = s->max_list, .format = info->format, .view = info->view};
    l.lanes = info->lanes;
    l.group = info->group;
    l.pitch = info->framebuffer && info->framebuffer_pitch
                  ? (uint32_t)(info->framebuffer_pitch / vit_format_bytes(info->format))
                  : s->width;
    if (info->max_nodes)
        l.max_nodes = info->max_nodes;
    if (info->max_list)
        l.max_list = info->max_list;
    if (info->view == VIT_VIEW_photons && (s->effects & ON(PHOTONS)))
        l.effects |= ON_DOTS;
    if (info->count_work)
        l.effects |= ON_WORK;
    if (info->record_reach)
        l.effects |= ON_REACH;
    if ((s->effects & ON(INDIRECT)) && !(s->effects & ON(SPARSE)))
        l.effects |= ON_DENSE;
    if ((s->effects & ON_RECEIVERS) && !(s->effects & ON(POINTS)))
        l.effects |= ON_CELLS;
    if (s->effects & (ON(MIRROR) | ON(GLASS)))
        l.effects |= ON_CHAINS;
    if (!(s->effects & ON(LIGHTMAP)) || (s->effects & ON(SPECULAR))) { /* lobes reflect what a lightmap does not say */
        l.effects |= s->effects & ON(SKY_LIGHT) ? ON_SKY_RAYS : 0;
        l.effects |= s->effects & ON(AREA_LIGHTS) ? ON_AREA_RAYS : 0;
    }
    if (vit_view_light(info->view) != 0 && (s->effects & (ON(ANTIALIAS) | ON(GLASS))))
        l.effects |= ON_FILM;
    l.layers = l.effects & ON_FILM && s->effects & ON(GLASS) ? 2 : 1;
    l.rounds = l.effects & ON_FILM ? l.layers * s->copies : 1;
    return l;
}

static size_t round_up(size_t bytes) {
    return (bytes + 63) / 64 * 64;
}

/* What the pack's sections take in the arena where they cannot be used as the file has them. Less than the pack's size and a
 * cache line each. */
static size_t swapped_bytes(const vit_pack *pack) {
    size_t sum = 0;
    for (int i = 0; VIT_BIG_ENDIAN && i < VIT_SECTION_COUNT; i++)
        sum += round_up(pack->bytes[i]);
    return sum;
}

/* Puts the sections, in the machine's byte order, at `to`. */
static void swap_sections(vit_pack *pack, char *to) {
    for (int i = 0; i < VIT_SECTION_COUNT; i++) {
        if (pack->bytes[i] > 0)
            pack->section[i] = vit_swap_words(to, pack->section[i], pack->bytes[i], VIT_WORD);
        to += round_up(pack->bytes[i]);
    }
    vit_swap_scene((vit_scene *)(uintptr_t)pack->section[VIT_SECTION_META]);
    pack->scene = pack->section[VIT_SECTION_META];
}

/* The arena: vit, the device's state, swapped sections, the device's memory. SIZE_MAX: more than there can be. */
static size_t host_bytes(const vit_device *d, const vit_pack *pack, const vit_launch *l, int in_place) {
    size_t own = round_up(sizeof(vit)) + round_up(d->state_bytes) + swapped_bytes(pack);
    size_t memory = d->memory_bytes(pack->scene, l, in_place);
    return memory <= SIZE_MAX - own ? own + memory : SIZE_MAX;
}

static void describe(const vit_device *d, const vit_pack *pack, const vit_launch *l, int in_place, vit_requirements *need) {
    const vit_scene *s = pack->scene;
    memset(need, 0, sizeof *need);
    need->width = s->width;
    need->height = s->height;
    need->frames = s->frames;
    need->fps = s->fps;
    need->effects = s->effects;
    need->host_bytes = host_bytes(d, pack, l, in_place);
    need->frame_bytes = vit_row_bytes(s, l) * s->height;
    for (uint32_t b = 0; b < B_COUNT; b++) {
        uint64_t bytes = vit_buffer_bytes(b, s, l);
        if (bytes == 0)
            continue;
        need->buffers[need->buffer_count++] = (vit_buffer_info){vit_buffer_names[b], vit_buffer_effect(b, l), bytes};
        need->device_bytes += bytes;
    }
    for (uint32_t p = 0; p < vit_pass_count; p++)
        if (vit_pass_called(p, l))
            need->passes[need->pass_count++] = vit_passes[p].name;
}

/* What vit_require() and vit_open() begin with. */
static vit_status look_at(const vit_open_info *info, vit_pack *pack, vit_launch *l, const vit_device **device, vit_text *why) {
    vit_status status = check_options(info, why);
    if (status == VIT_OK)
        status = vit_device_of(info->device, device, why);
    if (status == VIT_OK)
        status = vit_pack_read(info->pack, info->pack_size, pack, why);
    if (status == VIT_OK)
        status = check_framebuffer(info, pack->scene, why);
    if (status == VIT_OK)
        *l = launch_of(info, pack->scene);
    return status;
}

vit_status vit_require(const vit_open_info *info, vit_requirements *need, vit_text *why) {
    vit_text unused = {""};
    why = why ? why : &unused;
    vit_pack pack;
    vit_launch l;
    const vit_device *device;
    vit_status status = look_at(info, &pack, &l, &device, why);
    if (status == VIT_OK)
        describe(device, &pack, &l, info->framebuffer != NULL, need);
    return status;
}

/* Lays vit, the device's state and what was swapped out in the arena. NULL: it is too small, or not aligned. */
static vit *take_arena(const vit_open_info *info, const vit_pack *pack, const vit_launch *l, const vit_device *device,
                       vit_device_setup *setup, vit_text *why) {
    size_t need = host_bytes(device, pack, l, info->framebuffer != NULL);
    if (!info->arena || (uintptr_t)info->arena % 64 != 0 || info->arena_size < need) {
        vit_fail(why, VIT_USAGE, "the arena must be aligned to 64 bytes and hold %zu", need);
        return NULL;
    }
    vit *v = info->arena;
    memset(v, 0, round_up(sizeof *v) + round_up(device->state_bytes));
    v->pack = *pack;
    char *swapped = (char *)info->arena + round_up(sizeof *v) + round_up(device->state_bytes);
    if (VIT_BIG_ENDIAN)
        swap_sections(&v->pack, swapped);
    v->launch = *l;
    v->device = device;
    v->state = (char *)info->arena + round_up(sizeof *v);
    v->profile = info->profile != 0;
    v->history = VIT_NONE;
    *setup = (vit_device_setup){info, &v->pack, &v->launch, v->state, swapped + swapped_bytes(pack)};
    return v;
}

/* Devices leave work to the first run of a kernel: PoCL compiles it again for its size of work-group, drivers of GPUs load it.
 * So frame 0 is run once, with all its sizes, and what it left behind is taken back. */
static vit_status warm_up(vit *v, vit_text *why) {
    if (!v->device->rewind)
        return VIT_OK;
    vit_status status = vit_walk(v, 0, why);
    if (status == VIT_OK)
        status = v->device->show(v->state, NULL, 0, why);
    if (status == VIT_OK)
        status = v->device->rewind(v->state, why);
    if (status == VIT_OK)
        status = v->device->show(v->state, NULL, 0, why);
    if (v->profile)
        v->device->times(v->state, v->pass_ms);
    memset(v->pass_ms, 0, sizeof v->pass_ms);
    return status;
}

vit_status vit_open(const vit_open_info *info, vit **out, vit_text *why) {
    vit_text unused = {""};
    why = why ? why : &unused;
    vit_pack pack;
    vit_launch l;
    vit_device_setup setup;
    const vit_device *device;
    *out = NULL;
    vit_status status = look_at(info, &pack, &l, &device, why);
    if (status == VIT_OK)
        status = device->suit(info, pack.scene, &l, why);
    if (status != VIT_OK)
        return status;
    vit *v = take_arena(info, &pack, &l, device, &setup, why);
    if (!v)
        return VIT_USAGE;
    status = device->open(&setup, why);
    if (status == VIT_OK)
        status = warm_up(v, why);
    if (status == VIT_OK)
        *out = v;
    else
        device->close(v->state);
    return status;
}

void vit_close(vit *v) {
    if (v)
        v->device->close(v->state);
}

uint64_t vit_golden(const vit *v, uint32_t index) {
    const vit_gold *golds = v->pack.section[VIT_SECTION_GOLD];
    if (!golds || index >= v->pack.scene->frames || v->launch.view != VIT_VIEW_final)
        return 0;
    vit_gold gold = golds[index];
    const uint32_t *h = vit_gold_hash(&gold, v->launch.format);
    return (uint64_t)h[1] << 32 | h[0];
}
