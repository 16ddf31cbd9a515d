#include "common/file_trouble.h"
#include "import/image_file.h"
#include "import/importer.h"
#include <stb/stb_image.h>
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Texels that a byte of an image file can stand for: deflate's 1032 to 1, a bit a texel. A file that claims more is cut short,
 * and the decoder would fill gigabytes for it. */
#define TEXELS_A_BYTE (8 * 1032)

bool import_without(importer *im, const char *material, const char *name, const char *what, const char *instead) {
    if (im->strict)
        return import_fail(im, "material '%.100s': texture '%.200s' %s", material, name, what);
    import_warn(im, "material '%.100s': texture '%.200s' %s; %s", material, name, what, instead);
    return true;
}

static bool is_file(const char *path) {
    struct stat st;
    return stat(path, &st) == 0 && S_ISREG(st.st_mode) && st.st_size <= IMAGE_FILE_MOST;
}

static int hex(char c) {
    return isdigit((unsigned char)c) ? c - '0' : isxdigit((unsigned char)c) ? tolower((unsigned char)c) - 'a' + 10 : -1;
}

/* glTF names its files by URI: "my%20wood.png". */
static void decode_percent(char *text) {
    char *to = text;
    for (const char *c = text; *c; c++) {
        const int high = c[0] == '%' ? hex(c[1]) : -1;
        const int low = high >= 0 ? hex(c[2]) : -1;
        *to++ = low > 0 || (low == 0 && high > 0) ? (char)(high * 16 + low) : *c;
        if (low >= 0)
            c += 2;
    }
    *to = '\0';
}

/* Texture names are relative to the mesh's folder. An absolute one comes from its author's disk: its last part is tried here.
 */
static bool resolve(const importer *im, const char *name, char path[SCENE_PATH]) {
    char plain[SCENE_PATH];
    const char *slash = strrchr(im->file, '/');
    (void)snprintf(plain, sizeof plain, "%s", name);
    for (char *c = plain; *c; c++)
        if (*c == '\\')
            *c = '/';
    const char *relative = plain;
    const char *last = strrchr(plain, '/');
    if (last && (plain[0] == '/' || (isalpha((unsigned char)plain[0]) && plain[1] == ':')))
        relative = last + 1;
    for (int pass = 0; pass < 2; pass++) {
        const int used = snprintf(path, SCENE_PATH, "%.*s%s", slash ? (int)(slash + 1 - im->file) : 0, im->file, relative);
        if (used < 0 || used >= SCENE_PATH)
            return false;
        if (is_file(path))
            return true;
        decode_percent(plain + (relative - plain));
    }
    return false;
}

static const char *decode(importer *im, const uint8_t *bytes, int size, model_image *out) {
    int channels;
    if (!stbi_info_from_memory(bytes, size, &out->width, &out->height, &channels) || stbi_is_hdr_from_memory(bytes, size))
        return "is not an image that can be read (PNG, JPEG, TGA, BMP)";
    if (out->width < 1 || out->height < 1 || out->width > IMPORT_EDGE || out->height > IMPORT_EDGE)
        return "is larger than 16384 pixels";
    if ((uint64_t)out->width * (uint64_t)out->height > (uint64_t)size * TEXELS_A_BYTE)
        return "is broken";
    import_allow_texels(im, (uint64_t)out->width * (uint64_t)out->height);
    out->rgba = stbi_load_from_memory(bytes, size, &out->width, &out->height, &channels, 4);
    return out->rgba ? NULL : "is broken";
}

/* Assimp keeps embedded images as their file's bytes (height 0) or as BGRA texels. */
static const char *decode_embedded(importer *im, const struct aiTexture *t, model_image *out) {
    if (t->mHeight == 0)
        return t->mWidth > 0 && t->mWidth <= IMAGE_FILE_MOST ? decode(im, (const uint8_t *)t->pcData, (int)t->mWidth, out)
                                                             : "is empty";
    if (t->mWidth < 1 || t->mWidth > IMPORT_EDGE || t->mHeight > IMPORT_EDGE)
        return "is larger than 16384 pixels";
    const size_t texels = (size_t)t->mWidth * t->mHeight;
    out->width = (int)t->mWidth;
    out->height = (int)t->mHeight;
    out->rgba = malloc(4 * texels);
    for (size_t i = 0; out->rgba && i < texels; i++) {
        out->rgba[4 * i + 0] = t->pcData[i].r;
        out->rgba[4 * i + 1] = t->pcData[i].g;
        out->rgba[4 * i + 2] = t->pcData[i].b;
        out->rgba[4 * i + 3] = t->pcData[i].a;
    }
    return out->rgba ? NULL : "does not fit in memory";
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
    return !*end && end > name + 1 && index >= 0 && (unsigned long)index < im->ai->mNumTextures ? (int)index : -1;
}

static const char *load(importer *im, int embedded, model_image *out) {
    if (embedded >= 0)
        return decode_embedded(im, im->ai->mTextures[embedded], out);
    int size;
    uint8_t *bytes = image_file_read(out->name, &size);
    if (bytes)
        import_note_file(im, out->name, (size_t)size);
    const char *wrong = bytes                     ? decode(im, bytes, size, out)
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
        return resolve(im, name, found);
    return true;
}

const char *import_image(importer *im, const char *name, bool resolved, model_image *out) {
    int embedded;
    *out = (model_image){0};
    return locate(im, name, resolved, &embedded, out->name) ? load(im, embedded, out) : "is missing";
}

bool import_texture(importer *im, const char *name, bool resolved, const char *material, int *image) {
    static const char plain[] = "its plain colour is used";
    model *m = im->m;
    model_image loaded = {0};
    int embedded;
    *image = -1;
    if (!locate(im, name, resolved, &embedded, loaded.name))
        return import_without(im, material, name, "is missing", plain);
    *image = find_image(m, loaded.name);
    if (*image >= 0)
        return true;
    const char *wrong = load(im, embedded, &loaded);
    if (wrong)
        return import_without(im, material, name, wrong, plain);
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
