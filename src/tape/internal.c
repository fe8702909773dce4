#include "tape/internal.h"

#include "tape/formula.h"
#include "tape/internal_formulas.inc"
#include "tape/internal_parts.h"

#define FORMULA(number, name, inputs, text) \
    { number, "f_" #name, inputs, text, NULL, NULL }
#define UNROLLED(number, name, inputs) \
    { number, "f_" #name, inputs, NULL, internal_##name, unroll_##name }
static const InternalFunction functions[] = {
    FORMULA(0, algbr_cyl1, 8, ALGBR_CYL1),
    FORMULA(1, algbr_cyl2, 8, ALGBR_CYL2),
    FORMULA(2, algbr_cyl3, 8, ALGBR_CYL3),
    FORMULA(3, algbr_cyl4, 8, ALGBR_CYL4),
    FORMULA(4, bicorn, 5, BICORN),
    FORMULA(5, bifolia, 5, BIFOLIA),
    FORMULA(6, blob, 8, BLOB),
    FORMULA(7, blob2, 7, BLOB2),
    FORMULA(8, boy_surface, 5, BOY_SURFACE),
    FORMULA(9, comma, 4, COMMA),
    FORMULA(10, cross_ellipsoids, 7, CROSS_ELLIPSOIDS),
    FORMULA(11, crossed_trough, 4, CROSSED_TROUGH),
    FORMULA(12, cubic_saddle, 4, CUBIC_SADDLE),
    FORMULA(13, cushion, 4, CUSHION),
    FORMULA(14, devils_curve, 4, DEVILS_CURVE),
    FORMULA(15, devils_curve_2d, 9, DEVILS_CURVE_2D),
    FORMULA(16, dupin_cyclid, 9, DUPIN_CYCLID),
    FORMULA(17, ellipsoid, 6, ELLIPSOID),
    FORMULA(18, enneper, 4, ENNEPER),
    FORMULA(19, flange_cover, 7, FLANGE_COVER),
    FORMULA(20, folium_surface, 6, FOLIUM_SURFACE),
    FORMULA(21, folium_surface_2d, 9, FOLIUM_SURFACE_2D),
    FORMULA(22, glob, 4, GLOB),
    FORMULA(23, heart, 4, HEART),
    FORMULA(24, helical_torus, 13, HELICAL_TORUS),
    FORMULA(25, helix1, 10, HELIX1),
    FORMULA(26, helix2, 10, HELIX2),
    FORMULA(27, hex_x, 4, HEX_X),
    FORMULA(28, hex_y, 4, HEX_Y),
    UNROLLED(29, hetero_mf, 9),
    FORMULA(30, hunt_surface, 4, HUNT_SURFACE),
    FORMULA(31, hyperbolic_torus, 6, HYPERBOLIC_TORUS),
    FORMULA(32, isect_ellipsoids, 7, ISECT_ELLIPSOIDS),
    FORMULA(33, kampyle_of_eudoxus, 6, KAMPYLE_OF_EUDOXUS),
    FORMULA(34, kampyle_of_eudoxus_2d, 9, KAMPYLE_OF_EUDOXUS_2D),
    FORMULA(35, klein_bottle, 4, KLEIN_BOTTLE),
    FORMULA(36, kummer_surface_v1, 4, KUMMER_SURFACE_V1),
    FORMULA(37, kummer_surface_v2, 7, KUMMER_SURFACE_V2),
    FORMULA(38, lemniscate_of_gerono, 4, LEMNISCATE_OF_GERONO),
    FORMULA(39, lemniscate_of_gerono_2d, 9, LEMNISCATE_OF_GERONO_2D),
    FORMULA(40, mesh1, 8, MESH1),
    FORMULA(41, mitre, 4, MITRE),
    FORMULA(42, nodal_cubic, 4, NODAL_CUBIC),
    FORMULA(43, odd, 4, CUSHION),
    FORMULA(44, ovals_of_cassini, 7, OVALS_OF_CASSINI),
    FORMULA(45, paraboloid, 4, PARABOLOID),
    FORMULA(46, parabolic_torus, 6, PARABOLIC_TORUS),
    FORMULA(47, ph, 3, PH),
    FORMULA(48, pillow, 4, PILLOW),
    FORMULA(49, piriform, 4, PIRIFORM),
    FORMULA(50, piriform_2d, 10, PIRIFORM_2D),
    FORMULA(51, poly4, 8, POLY4),
    UNROLLED(52, polytubes, 9),
    FORMULA(53, quantum, 4, QUANTUM),
    FORMULA(54, quartic_paraboloid, 4, QUARTIC_PARABOLOID),
    FORMULA(55, quartic_saddle, 4, QUARTIC_SADDLE),
    FORMULA(56, quartic_cylinder, 6, QUARTIC_CYLINDER),
    FORMULA(57, r, 3, R),
    UNROLLED(58, ridge, 9),
    UNROLLED(59, ridged_mf, 9),
    FORMULA(60, rounded_box, 7, ROUNDED_BOX),
    FORMULA(61, sphere, 4, SPHERE),
    FORMULA(62, spikes, 8, SPIKES),
    FORMULA(63, spikes_2d, 7, SPIKES_2D),
    FORMULA(64, spiral, 9, SPIRAL),
    FORMULA(65, steiners_roman, 4, STEINERS_ROMAN),
    FORMULA(66, strophoid, 7, STROPHOID),
    FORMULA(67, strophoid_2d, 10, STROPHOID_2D),
    FORMULA(68, superellipsoid, 5, SUPERELLIPSOID),
    FORMULA(69, th, 3, TH),
    FORMULA(70, torus, 5, TORUS),
    FORMULA(71, torus2, 6, TORUS2),
    FORMULA(72, torus_gumdrop, 4, TORUS_GUMDROP),
    FORMULA(73, umbrella, 4, UMBRELLA),
    FORMULA(74, witch_of_agnesi, 5, WITCH_OF_AGNESI),
    FORMULA(75, witch_of_agnesi_2d, 9, WITCH_OF_AGNESI_2D),
    FORMULA(76, noise3d, 3, "f_noise3d(x, y, z)"),
    UNROLLED(78, noise_generator, 4),
};

const InternalFunction *internal_find(int number) {
    for (size_t i = 0; i < VTS_ARRAY_COUNT(functions); i++)
        if (functions[i].number == number) return &functions[i];
    return NULL;
}

const InternalFunction *internal_all(size_t *count) {
    *count = VTS_ARRAY_COUNT(functions);
    return functions;
}

bool internal_append(TapeBuilder *builder, const InternalFunction *function, const TapeRef *in, Span span, TapeRef *out) {
    if (function->formula) return formula_append(builder, function->formula, in, function->inputs, span, out);
    return function->unroll(builder, in, span, out);
}
