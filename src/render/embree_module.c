#include "render/embree_module.h"

#include "base/module.h"

bool embree_start(Embree *embree, StrBuf *why) {
    *embree = (Embree){.rtc = module_load("libvts_embree.so", "vts_embree_shim", EMBREE_SHIM_VERSION, why)};
    if (embree->rtc) embree->device = embree->rtc->NewDevice("threads=1,set_affinity=0");
    return embree->device != NULL;
}

void embree_stop(Embree *embree) {
    if (embree->device) embree->rtc->ReleaseDevice(embree->device);
    *embree = (Embree){0};
}
