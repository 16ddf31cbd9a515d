#include "common/octahedral.h"
#include <math.h>
#include <stdbool.h>

void octahedral_decode(const int s[2], int most, float n[3]) {
    const float x = (float)s[0] / (float)most, y = (float)s[1] / (float)most;
    const float z = (1.0f - fabsf(x)) - fabsf(y);
    const bool lower = z < 0.0f;
    const float fx = lower ? (1.0f - fabsf(y)) * (x < 0.0f ? -1.0f : 1.0f) : x;
    const float fy = lower ? (1.0f - fabsf(x)) * (y < 0.0f ? -1.0f : 1.0f) : y;
    const float l = sqrtf((fx * fx + fy * fy) + z * z);
    n[0] = fx / l;
    n[1] = fy / l;
    n[2] = z / l;
}

static int clamp(int s, int most) {
    return s < -most ? -most : s > most ? most : s;
}

void octahedral_encode(const float n[3], int most, int s[2]) {
    const float sum = (fabsf(n[0]) + fabsf(n[1])) + fabsf(n[2]);
    s[0] = s[1] = 0;
    if (!(sum > 0.0f))
        return;
    float x = n[0] / sum, y = n[1] / sum;
    if (n[2] < 0.0f) {
        const float fx = (1.0f - fabsf(y)) * (x < 0.0f ? -1.0f : 1.0f);
        y = (1.0f - fabsf(x)) * (y < 0.0f ? -1.0f : 1.0f);
        x = fx;
    }
    const int x0 = (int)floorf(x * (float)most), y0 = (int)floorf(y * (float)most);
    double best = 9.0;
    for (int i = 0; i < 4; i++) {
        const int code[2] = {clamp(x0 + (i & 1), most), clamp(y0 + (i >> 1), most)};
        float d[3];
        octahedral_decode(code, most, d);
        const double ex = (double)d[0] - (double)n[0], ey = (double)d[1] - (double)n[1], ez = (double)d[2] - (double)n[2];
        const double error = ex * ex + ey * ey + ez * ez;
        if (error < best) {
            best = error;
            s[0] = code[0];
            s[1] = code[1];
        }
    }
}
