/* POV-Ray's internal functions as formulas (formula.h): for internal.c alone. Where one looks odd (an angle taken at a point beside the
 * axis, a millionth that is taken away, fractions that vanish since they were meant for whole numbers), it is POV-Ray's, and scenes are
 * tuned to it. */
#ifndef VTS_TAPE_INTERNAL_FORMULAS_H
#define VTS_TAPE_INTERNAL_FORMULAS_H

#define PLACE "x2 = x*x; y2 = y*y; z2 = z*z; r2 = x2 + y2 + z2; disc = x2 + z2; across = sqrt(disc); "

/* ---- algebraic surfaces: a polynomial times the field strength p3, kept within ±10 ---- */

#define WITHIN_10(value) "min(10, max(-10, p3*(" value ")))"
#define ALGEBRAIC(value) PLACE WITHIN_10(value)
#define ALGEBRAIC_WITH(definitions, value) PLACE definitions WITHIN_10(value)

#define BICORN  ALGEBRAIC("y2*(p4^2 - disc) - (disc + 2*p4*y - p4^2)^2")
#define BIFOLIA ALGEBRAIC("p4*disc*y - r2^2")
/* In Apéry's implicit form. */
#define BOY_SURFACE                                                                                                                     \
    ALGEBRAIC_WITH("under = 1 - z; round = x2 + y2; root = sqrt(2);"                                                                    \
                   "third = 64*under^3*z^3 - 48*under^2*z2*(3*round + 2*z2);"                                                           \
                   "leaves = 12*under*z*(27*round^2 - 24*z2*round + 36*root*y*z*(y2 - 3*x2) + 4*z^4);"                                  \
                   "rest = (9*round - 2*z2)*(-81*round^2 - 72*z2*round + 108*root*x*z*(x2 - 3*y2) + 4*z^4);",                           \
                   "p4*(third + leaves + rest)")
#define CROSSED_TROUGH ALGEBRAIC("x2*z2 - y")
#define CUBIC_SADDLE   ALGEBRAIC("z - x^3 + y^3")
#define CUSHION        ALGEBRAIC("x2*(z - 1)^2 - z2*(z - 1)^2 - (x2 - z)^2 - y2*(y2 + 2*x2 + z2 - 2*z - 1)")
#define DEVILS_CURVE   ALGEBRAIC("y2*(y2 - 0.25) - x2*(x2 + 2*z2 - 0.36) - z^4")
/* Major and minor radius of the torus, its place in x and y, the radius of inversion. */
#define DUPIN_CYCLID                                                                                                                    \
    ALGEBRAIC_WITH("major = p4^2; minor = p5^2; dx = p6^2; dy = p7^2; inversion = p8^2; shift = p6*x + p7*y;"                           \
                   "far = minor - dy - (p6 + p4)^2; near = minor - dy - (p6 - p4)^2;"                                                   \
                   "linear = (minor + major - dy - dx)*(2*shift - inversion) - 4*p7*minor*y;",                                          \
                   "-(far*near*r2^2 + 2*inversion*linear*r2 + (4*inversion^2*(shift*(shift - inversion) + major*y2) + inversion^4))")
#define ENNEPER              ALGEBRAIC_WITH("height = select(abs(z) - 0.2, 0.2, z); saddle = (y2 - x2)/(2*height);", "6*(saddle/2)^2 - (saddle + 2*z2/9)^3")
#define FOLIUM_SURFACE       ALGEBRAIC("(y2 + z2)*(1 + (p5 - 4*p4)*x) + x2*(1 + p5)")
#define GLOB                 ALGEBRAIC("0.5*x^4*(x + 1) - (y2 + z2)")
#define HEART                ALGEBRAIC("0.1*x2*z^3 + y2*z^3 - (r2 + x2 - 1)^3")
#define HUNT_SURFACE         ALGEBRAIC("-4*(r2 - 13)^3 - 27*(3*x2 + y2 - 4*z2 - 12)^2")
#define SQUARED_RADII        "more = p4^2 + p5^2; less = p4^2 - p5^2;"
#define HYPERBOLIC_TORUS     ALGEBRAIC_WITH(SQUARED_RADII, "-((x2 + y2 - z2)^2 + 2*(less*y2 - more*x2 + more*z2) + less^2)")
#define KAMPYLE_OF_EUDOXUS   ALGEBRAIC("p5^2*x2*(x2 - p4^2) - (y2 + z2)")
#define KLEIN_BOTTLE         ALGEBRAIC_WITH("inner = r2 - 2*y - 1; outer = r2 + 2*y - 1;", "-outer*(inner^2 - 8*z2) - 16*x*z*inner")
#define MIXED_SQUARES        "(x2*y2 + x2*z2 + y2*z2)"
#define FOURTH_POWERS        "(x^4 + y^4 + z^4)"
#define KUMMER_SURFACE_V1    ALGEBRAIC("r2 + " MIXED_SQUARES " - " FOURTH_POWERS " - 1")
#define KUMMER_SURFACE_V2    ALGEBRAIC("1 - " FOURTH_POWERS " - p4*r2 - p5*" MIXED_SQUARES " - p6*x*y*z")
#define LEMNISCATE_OF_GERONO ALGEBRAIC("x2 - x^4 - y2 - z2")
#define MITRE                ALGEBRAIC("y2*(1 - y2 - z2) - 4*x2*r2")
#define NODAL_CUBIC          ALGEBRAIC("6*y*z - y^3 - z^3")
#define OVALS_OF_CASSINI     ALGEBRAIC("p6*p4^2*disc + p5^2 - (r2 + p4^2)^2")
#define PARABOLOID           ALGEBRAIC("y - x2 - z2")
#define PARABOLIC_TORUS      ALGEBRAIC_WITH(SQUARED_RADII, "-((x2 + y2 - z)^2 - more*x2 + less*y2 + more*z + less^2)")
#define PILLOW               ALGEBRAIC(FOURTH_POWERS " - r2")
#define PIRIFORM             ALGEBRAIC("x^4 - x^3 + y2 + z2")
#define QUARTIC_PARABOLOID   ALGEBRAIC("y - x^4 - z^4")
#define QUARTIC_SADDLE       ALGEBRAIC("y - x^4 + z^4")
#define QUARTIC_CYLINDER     ALGEBRAIC("p5^2*p4^2 - disc*(y2 + p5^2)")
#define STEINERS_ROMAN       ALGEBRAIC("-" MIXED_SQUARES " - x*y*z")
#define STROPHOID            ALGEBRAIC("p6^2*x2*(p4 + x) - (p5 - x)*(y2 + z2)")
#define TORUS2               ALGEBRAIC_WITH(SQUARED_RADII, "2*(more*disc - less*y2) - r2^2 - less^2")
#define TORUS_GUMDROP        ALGEBRAIC_WITH("round = y2 + z2;", "20*r2 - 17 - 17*x2*round - 4*(x^4 + round^2)")
#define UMBRELLA             ALGEBRAIC("y*z^2 - x^2")
#define WITCH_OF_AGNESI      ALGEBRAIC("p4*(1 - y) - disc*y")

/* ---- plane curves of u and v: extruded along z or, where `sweep` is above 0, round the y axis at a distance, turned by an angle ---- */

#define SECTION(sweep, distance, angle)                                                                      \
    PLACE "off = across - " distance "; turn = radians(" angle "); c = cos(turn); s = sin(turn);"            \
          "u = select(-" sweep ", off*c - y*s, x); v = select(-" sweep ", off*s + y*c, y); u2 = u*u; v2 = v*v; "

/* The cylinders' limit is a parameter; a negative one wins over what it should bound, as in POV-Ray. */
#define CYLINDER(sign, value)         SECTION("p5", "p6", "p7") sign "min(max(p3*(" value "), -p4), p4)"
#define ALGBR_CYL1                    CYLINDER("-", "u2*(1 - abs(u)) - v2")
#define ALGBR_CYL2                    CYLINDER("", "3*u2*v + 2*v^3 - 2*u^4 - v^4 - v2")
#define ALGBR_CYL3                    CYLINDER("", "2*u2*v + u*v2 - u^4 - u2*v2 - v2")
#define ALGBR_CYL4                    CYLINDER("", "v^3 - 3*u2*v - (u2 + v2)^2")
#define DEVILS_CURVE_2D               SECTION("p6", "p7", "p8") WITHIN_10("v2*(v2 - p5*p5) - u2*(u2 - p4*p4)")
#define FOLIUM_SURFACE_2D             SECTION("p6", "p7", "p8") WITHIN_10("-v2*(1 + (p5 - 4*p4)*u) - u2*(1 + p5)")
/* The plane curve multiplies its two parameters where the surface squares the first. */
#define KAMPYLE_OF_EUDOXUS_2D         SECTION("p6", "p7", "p8") WITHIN_10("p5*p5*u2*(u2 - p4*p5) - v2")
#define LEMNISCATE_OF_GERONO_2D       SECTION("p6", "p7", "p8") WITHIN_10("p5*p5*u2*(p4*p4 - u2) - v2")
#define PIRIFORM_2D                   SECTION("p7", "p8", "p9") WITHIN_10("p6*p6*u2*(p4*u + p5*u2) - v2")
#define STROPHOID_2D                  SECTION("p7", "p8", "p9") WITHIN_10("p6*p6*u2*(p4 + u) - (p5 - u)*v2")
#define WITCH_OF_AGNESI_2D            SECTION("p6", "p7", "p8") WITHIN_10("p5 - v*(p4*p4 + u2)")

/* ---- distances and angles ---- */

#define R                  PLACE "sqrt(r2)"
#define TH                 "atan2(x, z)"
#define PH                 PLACE "atan2(across, y)"
#define SPHERE             PLACE "sqrt(r2) - p3"
#define ELLIPSOID          "sqrt((x*p3)^2 + (y*p4)^2 + (z*p5)^2)"
#define TORUS              PLACE "sqrt((across - p3)^2 + y2) - p4"
#define BEYOND(axis, size) "max(0, abs(" axis ") - (" size " - p3))^2"
#define ROUNDED_BOX        "sqrt(" BEYOND("x", "p4") " + " BEYOND("y", "p5") " + " BEYOND("z", "p6") ") - p3 - 0.000001"
#define SUPERELLIPSOID                                                                                                                  \
    "east = 2/p3; north = 1/p4; side = pow(pow(abs(x), east) + pow(abs(y), east), p3*north);"                                           \
    "1 - pow(side + pow(abs(z), 2*north), p4/2)"

/* ---- sums of bumps ---- */

#define BLOB                                                                                                                            \
    PLACE "off = y2 + z2; half = p3/2; first = min(((x + half)^2 + off)*p5*p5, 1); second = min(((x - half)^2 + off)*p7*p7, 1);"        \
          "-(p4*(1 - first)^2 + p6*(1 - second)^2)"
#define BLOB2 PLACE "off = y2 + z2; p6 - (exp(-(x2 + off)*p4) + exp(-((x - p3)^2 + off)*p4))*p5"
/* Each long in one axis: the squares of the others count p3 times. */
#define BUMPS PLACE "a = exp(-(x2 + (y2 + z2)*p3)*p4); b = exp(-(y2 + (x2 + z2)*p3)*p4); c = exp(-(z2 + (x2 + y2)*p3)*p4);"
#define CROSS_ELLIPSOIDS BUMPS "p6 - max(max(c, b), a)*p5"
#define ISECT_ELLIPSOIDS BUMPS "p6 - min(min(c, b), a)*p5"
#define FLANGE_COVER     BUMPS "p6 - (c + b + a)*p5"
#define SPIKES           BUMPS "-(exp(-r2*p6)*p7 - c - b - a)*p5"
#define SPIKES_2D        PLACE "y - p3*cos(p4*x)*cos(p5*z)*exp(-p6*disc)"

/* ---- along and round y ---- */

#define POLY4     PLACE "across - max(p3 + y*(p4 + y*(p5 + y*(p6 + y*p7))), -5)"
#define ON_AXIS   "axis = and(eq(x, 0), eq(z, 0)); "
#define QUANTUM                                                                                                                         \
    PLACE ON_AXIS "off = sqrt(select(-axis, 0.000000000001, disc)); cosine = cos(atan2(off, y)); radius = 2*sqrt(off^2 + y2);"          \
                  "wave = radius^2*exp(-radius*0.33333333)*(3*cosine^2 - 1); -0.1*(wave^2 - 12)"
#define COMMA                                                                                                                           \
    ON_AXIS "u = select(-axis, 0.0001, x); z2 = z*z; y2 = y*y;"                                                                         \
            "tail = cos(atan2(z, u)/2)*p3/2 - sqrt((sqrt((u + p3/4)^2 + z2) - p3*0.75)^2 + y2);"                                        \
            "head = p3/2 - sqrt((u - p3/2)^2 + z2 + y2); -max(min(z, tail), head)"

/* ---- helices ---- */

/* Where what follows is the same for both sides of the middle of a period, fold() knows that nothing jumps at its ends. */
#define POSITIVE_MOD(name, value, period) "rest = mod(" value ", " period "); " name " = select(rest, rest + " period ", rest); "
/* `tube`: how far (a, b) is from the middle of a cross section; 1 round, 2 a diamond, towards 0 a rectangle. */
#define CROSS_SECTION(a, b, shape)                                                                                                      \
    "a = " a "; b = " b "; power = 2/" shape ";"                                                                                        \
    "flat = select(-eq(" shape ", 0), max(abs(a), abs(b)), pow(pow(abs(a), power) + pow(abs(b), power), " shape "/2));"                 \
    "tube = select(-eq(" shape ", 1), sqrt(a^2 + b^2), flat); "
#define ANGLE ON_AXIS "angle = select(-axis, 0, atan2(z, x)); "
/* Windings, turns per unit, minor and major radius, shape, cross section, its angle. */
#define HELIX1                                                                                                                          \
    PLACE ANGLE POSITIVE_MOD("phase", "angle*p3 + y*p4*p3", "(2*pi)")                                                                   \
    "turns = and(ne(p8, 1), ne(p9, 0)); off = across - p6;"                                                                             \
    "along = select(-turns, phase - pi, fold(angle*p3 + y*p4*p3, 2*pi))/p7/(p4*p3); turn = radians(p9); c = cos(turn); s = sin(turn);" \
    "u = select(-turns, off*c - along*s, off); v = select(-turns, off*s + along*c, along);"                                             \
    CROSS_SECTION("u", "v", "p8") "min(p6 + across, tube) - p5"
#define HELIX2                                                                                                                          \
    "c = cos(y*p4); s = sin(y*p4); u = x - p6*c; w = z - p6*s;" CROSS_SECTION("u*c + w*s", "w*c - u*s", "p8") "tube - p5"
#define SPIRAL                                                                                                                          \
    PLACE ANGLE "winding = across + p3*angle/(2*pi); first = mod(winding, p3) - p3/2;"                                                        \
    CROSS_SECTION("select(min(p3, winding), first, fold(winding, p3))", "y", "p8")                               \
    "radius = sqrt(select(-axis, 0.000000000001, disc) + y2); -min(p5 - radius, p4 - min(tube, radius))"
#define HELICAL_TORUS                                                                                                                   \
    PLACE ON_AXIS "round = select(-axis, pi/2, atan2(x, z)); tube = sqrt((across - p3)^2 + y2);"                                        \
    "wound = round*p4 + atan2(across - p3, y)*p5; way = fold(wound, 2*pi);" POSITIVE_MOD("turned", "wound", "(2*pi)")                                      \
    "groove = cos(atan2((turned - pi)*p11, tube - p8)*p10 + round*p12)*p6 + p7;"                                                                \
    "ridge = groove - min(sqrt((tube - p8)^2 + way^2*p9), tube + p8); -max(p7 + p8 - p3 - across, ridge)"

/* ---- grids ---- */

/* (u, v): the place folded into the twelfth of a hexagonal cell. */
#define HEX_FOLD                                                                                                                        \
    "width = sqrt(3); a = abs(mod(abs(x), width) - width/2); b = abs(mod(abs(y), 3) - 1.5); c = width/2 - a; d = 1.5 - b;"              \
    "other = gt(a^2 + b^2, c^2 + d^2); u = select(-other, c, a); v = select(-other, d, b); beside = atan2(v, u) - pi/6; "
#define HEX_X HEX_FOLD "select(beside, u, cos(pi/3)*u + sin(pi/3)*v)"
#define HEX_Y HEX_FOLD "select(beside, v, abs(cos(pi/3)*v - sin(pi/3)*u))"

/* A thread along the other axis, going up and down as a cosine: its distance from (place, height). */
#define THREAD(name, place, spacing, height)                                                                                            \
    "off = fold(" place ", 2*" spacing ")*p5; " name " = sqrt(((" height ")*p7)^2 + off^2); "
/* Distances of the threads in x and z, their stretch, height of the waves, stretch in y. */
#define MESH1                                                                                                                           \
    "over_x = cos(x*pi/p3)*p6; over_z = cos(z*pi/p4)*p6;"                                                                               \
    THREAD("a", "x", "p3", "y - over_z") THREAD("b", "x - p3", "p3", "y + over_z")                                                      \
    THREAD("c", "z", "p4", "y + over_x") THREAD("d", "z - p4", "p4", "y - over_x") "min(min(a, b), min(c, d))"

#endif
