/* Where the sun stands. Own series after Meeus, Astronomical Algorithms (2nd ed. 1998), chapters 22, 25 and 12: good to some thousandths
 * of a degree from 1800 to 2200. */
#ifndef VTS_TERRAIN_SUN_H
#define VTS_TERRAIN_SUN_H

#include "base/strbuf.h"
#include "terrain/geodesy.h"

/* Days since 2000-01-01 12:00 UTC (J2000) of an ISO 8601 text: "2026-06-21", with a time "T10:00", "T10:00:30.5", and a zone "Z",
 * "+02:00", "+0200", "+02"; without one it is UTC, which "Z" only says aloud. False with a line of text in `error`. */
bool sun_parse_time(const char *text, double *days, StrBuf *error);

/* The unit vector (east, up, north) from a place towards the middle of the sun: its true direction, with parallax and aberration, not
 * bent by the air. */
Vec3 sun_direction(GeoPlace place, double days);

#endif
