#include "common/file_trouble.h"
#include "import/image_file.h"
#include "import/image_head.h"
#include "import/image_whole.h"
#include "import/importer.h"
#include "import/webp.h"
#include <stb/stb_image.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Texels that a byte of an image file can stand for: deflate's 1032 to 1, a bit a texel. A file that claims more is cut short,
 * and the decoder would fill gigabytes for it. */
#define TEXELS_A_BYTE (8 * 1032)
#define WEBP_TEXELS ((uint64_t)1 << 24)

bool import_without(importer *im, const char *material, const char *name, const char *what, const char *instead) {
    if (im->rigour == MODEL_STRICT)
        return import_fail(im, "material '%.100s': texture '%.200s' %s", material, name, what);
    import_warn(im, "material '%.100s': texture '%.200s' %s; %s", material, name, what, instead);
    return true;
}

/* Size and kind by the bytes alone. What keeps them from being an image that can be read, or NULL. */
static const char *read_head(const uint8_t *bytes, size_t size, model_image *out, bool *webp) {
    if (size == 0)
        return "is empty";
    if (size > IMAGE_FILE_MOST)
        return "is too long";
    *webp = webp_is_it(bytes, size);
    const char *wrong = image_head_jpeg(bytes, size);
    if (wrong)
        return wrong;
    if (size >= 12 && memcmp(bytes, "\xabKTX 20\xbb\r\n\x1a\n", 12) == 0)
        return "is KTX2, which is not read: no library for it is packaged; save it as PNG, JPEG or WebP";
    if (image_is_packed_bmp(bytes, size))
        return "is a BMP with run lengths, which is not read: save it without, or as PNG";
    if (*webp ? !webp_size(bytes, size, &out->width, &out->height)
              : !image_head_size(bytes, size, &out->width, &out->height) || stbi_is_hdr_from_memory(bytes, (int)size))
        return "is not an image that can be read (PNG, JPEG, WebP, TGA, BMP, of up to 16384 pixels an edge)";
    if (out->width < 1 || out->height < 1 || out->width > IMPORT_EDGE || out->height > IMPORT_EDGE)
        return "is larger than 16384 pixels";
    /* WebP has large pictures of one colour in some 30 bytes. */
    const uint64_t texels = (uint64_t)out->width * (uint64_t)out->height;
    if (texels > size * TEXELS_A_BYTE && !(*webp && texels <= WEBP_TEXELS))
        return "is broken";
    return image_is_cut(bytes, size) ? "is cut short" : NULL;
}

const char *import_decode(importer *im, const uint8_t *bytes, size_t size, model_image *out) {
    int channels;
    bool webp;
    const char *wrong = read_head(bytes, size, out, &webp);
    if (wrong)
        return wrong;
    const double gamma = image_head_gamma(bytes, size);
    if (gamma > 0.0 && im->rigour == MODEL_STRICT)
        return "states a gamma that is not sRGB's";
    if (gamma > 0.0)
        import_warn(im, "texture '%.200s' states a gamma of %.4g; it is taken as sRGB", out->name, gamma);
    import_allow_texels(im, (uint64_t)out->width * (uint64_t)out->height);
    out->rgba = webp ? webp_decode(bytes, size, out->width, out->height)
                     : stbi_load_from_memory(bytes, (int)size, &out->width, &out->height, &channels, 4);
    if (!out->rgba)
        return "is broken";
    image_turn(bytes, size, out->rgba, out->width, out->height);
    return NULL;
}

static int find_image(const model *m, const char *name) {
    for (int i = 0; i < m->image_count; i++)
        if (!strcmp(m->images[i].name, name))
            return i;
    return -1;
}

/* Index of the embedded image "*7", or -1. */
static int embedded_index(const importer *im, const char *name) {
    if (name[0] != '*')
        return -1;
    char *end;
    const long index = strtol(name + 1, &end, 10);
    return !*end && end > name + 1 && index >= 0 && (unsigned long)index < im->embedded ? (int)index : -1;
}

static const char *load(importer *im, int embedded, model_image *out) {
    if (embedded >= 0)
        return im->format->image(im, (unsigned)embedded, out);
    int size;
    uint8_t *bytes = image_file_read(out->name, &size);
    if (bytes)
        import_note_file(im, out->name, (size_t)size);
    const char *wrong = bytes                     ? import_decode(im, bytes, (size_t)size, out)
                        : file_trouble(out->name) ? file_trouble(out->name)
                                                  : "is empty or cannot be read";
    free(bytes);
    return wrong;
}

/* Where an image comes from: its name in the model in `found`, and its embedded index or -1. */
static bool locate(const importer *im, const char *name, bool resolved, int *embedded, char found[SCENE_PATH]) {
    *embedded = resolved ? -1 : embedded_index(im, name);
    if (resolved)
        (void)snprintf(found, SCENE_PATH, "%s", name);
    else if (*embedded >= 0)
        (void)snprintf(found, SCENE_PATH, "%.*s#%d", SCENE_PATH - 16, im->file, *embedded);
    else
        return import_resolve(im, name, found);
    return true;
}

const char *import_image(importer *im, const char *name, bool resolved, model_image *out) {
    int embedded;
    *out = (model_image){0};
    return locate(im, name, resolved, &embedded, out->name) ? load(im, embedded, out) : "is missing";
}

bool import_texture(importer *im, const char *name, bool resolved, const char *material, const char *instead, int *image) {
    model *m = im->m;
    model_image loaded = {0};
    int embedded;
    *image = -1;
    if (!locate(im, name, resolved, &embedded, loaded.name))
        return import_without(im, material, name, "is missing", instead);
    *image = find_image(m, loaded.name);
    if (*image >= 0)
        return true;
    const char *wrong = load(im, embedded, &loaded);
    if (wrong)
        return import_without(im, material, name, wrong, instead);
    im->texels += (uint64_t)loaded.width * (uint64_t)loaded.height;
    if (im->texels > IMPORT_TEXELS ||
        !import_room(im, &m->images, &im->image_room, (size_t)m->image_count + 1, sizeof *m->images)) {
        stbi_image_free(loaded.rgba);
        return im->texels > IMPORT_TEXELS ? import_fail(im, "the textures have more than 2^30 texels together") : false;
    }
    *image = m->image_count++;
    m->images[*image] = loaded;
    return true;
}
