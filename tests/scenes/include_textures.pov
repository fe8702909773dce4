#include "four.inc"
#include "textures.inc"
Four(texture { Jade scale 2 }, texture { DMFWood4 scale 1.4 }, texture { PinkAlabaster scale 2 }, texture { Cork scale 2 })
