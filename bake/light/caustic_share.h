/* caustic_share.c: how much of the light that surfaces get straight from lights comes by mirrors and glass. */
#ifndef VIT_LIGHT_CAUSTIC_SHARE_H
#define VIT_LIGHT_CAUSTIC_SHARE_H

#include "light/photon_emission.h"

/* Power that arrives at matt surfaces, W, a channel's mean. */
typedef struct caustic_share {
    double straight, by_specular; /* with nothing on the way; by mirrors and glass, panes among them */
} caustic_share;

/* Of one light, by l->paths paths. False: out of memory. Threads change no bit. */
bool caustic_share_find(const photon_rays *rays, const photons_light *l, unsigned threads, caustic_share *out);

#endif
