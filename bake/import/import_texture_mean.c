/* What a material without texels takes for a texture: the mean of them. */
#include "common/strict_math.h"
#include "import/importer.h"
#include <stb/stb_image.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct texture_mean {
    char name[SCENE_PATH]; /* as import_image() takes it */
    bool srgb;
    float mean[4];
} texture_mean;

/* Counts of each value first: 256 powers, and a sum that does not depend on the texels' order. */
static void mean_of(const model_image *image, bool srgb, float mean[4]) {
    const size_t texels = (size_t)image->width * (size_t)image->height;
    for (size_t k = 0; k < 4; k++) {
        uint64_t counts[256] = {0};
        double sum = 0.0;
        for (size_t i = 0; i < texels; i++)
            counts[image->rgba[4 * i + k]]++;
        for (unsigned v = 0; v < 256; v++)
            sum += (double)counts[v] * (srgb && k < 3 ? srgb_linear(v / 255.0) : v / 255.0);
        mean[k] = (float)(sum / (double)texels);
    }
}

bool import_texture_mean(importer *im, const char *name, const char *material, bool srgb, float mean[4]) {
    texture_mean found = {.srgb = srgb, .mean = {1.0f, 1.0f, 1.0f, 1.0f}};
    model_image image;
    memcpy(mean, found.mean, sizeof found.mean);
    for (size_t i = 0; i < im->mean_count; i++)
        if (im->means[i].srgb == srgb && !strcmp(im->means[i].name, name)) {
            memcpy(mean, im->means[i].mean, sizeof im->means[i].mean);
            return true;
        }
    const char *wrong = import_image(im, name, false, &image);
    if (wrong)
        return !material || import_without(im, material, name, wrong, "done without it");
    mean_of(&image, srgb, found.mean);
    stbi_image_free(image.rgba);
    (void)snprintf(found.name, sizeof found.name, "%s", name);
    if (!import_room(im, &im->means, &im->mean_room, im->mean_count + 1, sizeof *im->means))
        return false;
    im->means[im->mean_count++] = found;
    memcpy(mean, found.mean, sizeof found.mean);
    return true;
}
