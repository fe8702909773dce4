/* Coordinate systems as texts: well-known text (OGC 01-009, ESRI's dialect, ISO 19162), and the keywords of Arc/Info's .prj files. */
#include "terrain/map_place.h"
#include "terrain/text_scan.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { DEEPEST = 16, MOST_NODES = 512, NAME_SIZE = 80 };

/* NAME["text", 1.5, CHILD[…], …] */
typedef struct Node {
    char name[NAME_SIZE]; /* letters and digits in lower case, nothing else */
    char text[NAME_SIZE]; /* likewise: the first text within */
    double numbers[4];
    int number_count;
    int parent;
} Node;

typedef struct Tree {
    const char *at, *end;
    Node nodes[MOST_NODES]; /* in the order of the text */
    int count;
} Tree;

/* "WGS_1984" and "WGS 1984" are the same. */
static void simplify(char out[NAME_SIZE], const char *text, size_t size) {
    size_t used = 0;
    for (size_t i = 0; i < size && used + 1 < NAME_SIZE; i++)
        if (isalnum((unsigned char)text[i])) out[used++] = (char)tolower((unsigned char)text[i]);
    out[used] = '\0';
}

static void skip_blanks(Tree *tree) {
    while (tree->at < tree->end && (isspace((unsigned char)*tree->at) || *tree->at == ',')) tree->at++;
}

static bool is_bracket(char c, char open, char other) { return c == open || c == other; }

static void read_text(Tree *tree, int node) {
    const char *begin = ++tree->at;
    while (tree->at < tree->end && *tree->at != '"') tree->at++;
    if (node >= 0 && !tree->nodes[node].text[0]) simplify(tree->nodes[node].text, begin, (size_t)(tree->at - begin));
    if (tree->at < tree->end) tree->at++;
}

/* A name or a number; a name with a bracket behind it opens a node. Returns the node that what follows lies in. */
static int read_word(Tree *tree, int node) {
    const char *begin = tree->at;
    while (tree->at < tree->end && (isalnum((unsigned char)*tree->at) || strchr("_+-.", *tree->at))) tree->at++;
    size_t size = (size_t)(tree->at - begin);
    double value;
    if (size == 0) {
        tree->at++;
        return node;
    }
    skip_blanks(tree);
    if (tree->at < tree->end && is_bracket(*tree->at, '[', '(') && tree->count < MOST_NODES) {
        tree->at++;
        tree->nodes[tree->count] = (Node){.parent = node};
        simplify(tree->nodes[tree->count].name, begin, size);
        return tree->count++;
    }
    if (node >= 0 && tree->nodes[node].number_count < 4 && text_number(begin, size, &value) && isfinite(value))
        tree->nodes[node].numbers[tree->nodes[node].number_count++] = value;
    return node;
}

static void read_tree(Tree *tree) {
    int node = -1;
    for (skip_blanks(tree); tree->at < tree->end; skip_blanks(tree)) {
        if (*tree->at == '"') {
            read_text(tree, node);
        } else if (is_bracket(*tree->at, ']', ')')) {
            tree->at++;
            node = node >= 0 ? tree->nodes[node].parent : -1;
        } else {
            node = read_word(tree, node);
        }
    }
}

/* The first node of that name within `within` (-1: anywhere) and directly in it if `direct`. */
static int find(const Tree *tree, int within, const char *name, bool direct) {
    for (int i = within + 1; i < tree->count; i++) {
        int up = tree->nodes[i].parent;
        while (!direct && up > within) up = tree->nodes[up].parent;
        if ((within < 0 || up == within) && strcmp(tree->nodes[i].name, name) == 0) return i;
    }
    return -1;
}

static int find_any(const Tree *tree, int within, const char *const names[2], bool direct) {
    int first = find(tree, within, names[0], direct);
    return first >= 0 ? first : find(tree, within, names[1], direct);
}

static double number_of(const Tree *tree, int node, double otherwise) {
    return node >= 0 && tree->nodes[node].number_count > 0 ? tree->nodes[node].numbers[0] : otherwise;
}

/* Datums that differ from WGS84 by less than two metres; anything else would need a shift. */
static bool is_global_datum(const char *name) {
    static const char *const known[] = {"wgs84",  "wgs1984", "worldgeodeticsystem1984", "nad83", "northamerican1983", "northamericandatum1983",
                                        "etrs",   "europeanterrestrialreferencesystem1989", "gda", "geocentricdatumofaustralia", "nzgd2000",
                                        "newzealandgeodeticdatum2000", "newzealand2000", "jgd2000", "jgd2011", "japanesegeodeticdatum2", "rgf", "reseaugeodesiquefrancais1993",
                                        "sirgas", "sistemadereferenciageocentrico", "itrf", "cgcs2000", "china2000", "korea2000", "korean", "hartebeesthoek94", "rgaf09"};
    const char *at = name[0] == 'd' && strncmp(name, "dwgs", 4) == 0 ? name + 1 : name;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(known); i++)
        if (strncmp(at, known[i], strlen(known[i])) == 0 || (name[0] == 'd' && strncmp(name + 1, known[i], strlen(known[i])) == 0)) return true;
    return false;
}

static bool refuse_datum(StrBuf *error, const char *datum) {
    return map_fail(error, "its datum '%s' lies apart from WGS84 by up to hundreds of metres, and no shift is known here: convert the map (gdalwarp -t_srs EPSG:4326), or place it with georeference",
                    datum);
}

static const struct {
    const char *name; /* what the method's name begins with; the first that fits */
    ProjectionKind kind;
    double pole; /* latitude of the pole that the name tells */
} METHODS[] = {
    {"transversemercator", PROJECTION_TRANSVERSE_MERCATOR, 0},
    {"gausskruger", PROJECTION_TRANSVERSE_MERCATOR, 0},
    {"lambertconformalconic", PROJECTION_LAMBERT_CONFORMAL, 0},
    {"lambertconicconformal", PROJECTION_LAMBERT_CONFORMAL, 0},
    {"albers", PROJECTION_ALBERS, 0},
    {"stereographicnorthpole", PROJECTION_POLAR_STEREOGRAPHIC, 90},
    {"stereographicsouthpole", PROJECTION_POLAR_STEREOGRAPHIC, -90},
    {"polarstereographic", PROJECTION_POLAR_STEREOGRAPHIC, 0},
    {"mercatorauxiliarysphere", PROJECTION_WEB_MERCATOR, 0},
    {"popularvisualisation", PROJECTION_WEB_MERCATOR, 0},
    {"mercator", PROJECTION_MERCATOR, 0},
    {"lambertazimuthalequalarea", PROJECTION_LAMBERT_AZIMUTHAL, 0},
    {"equidistantcylindrical", PROJECTION_EQUIRECTANGULAR, 0},
    {"equirectangular", PROJECTION_EQUIRECTANGULAR, 0},
    {"platecarree", PROJECTION_EQUIRECTANGULAR, 0},
};

typedef enum ParameterField { TO_LATITUDE, TO_LONGITUDE, TO_PARALLEL_1, TO_PARALLEL_2, TO_SCALE, TO_EAST, TO_NORTH, TO_NOTHING } ParameterField;
static const struct {
    const char *name;
    ParameterField field;
} PARAMETERS[] = {
    {"latitudeoforigin", TO_LATITUDE},   {"latitudeofcenter", TO_LATITUDE},        {"latitudeofcentre", TO_LATITUDE},
    {"latitudeofnaturalorigin", TO_LATITUDE}, {"latitudeoffalseorigin", TO_LATITUDE}, {"centralmeridian", TO_LONGITUDE},
    {"longitudeofcenter", TO_LONGITUDE}, {"longitudeofcentre", TO_LONGITUDE},      {"longitudeofnaturalorigin", TO_LONGITUDE},
    {"longitudeoffalseorigin", TO_LONGITUDE}, {"longitudeoforigin", TO_LONGITUDE}, {"standardparallel1", TO_PARALLEL_1}, {"standardparallel2", TO_PARALLEL_2},
    {"latitudeof1ststandardparallel", TO_PARALLEL_1}, {"latitudeof2ndstandardparallel", TO_PARALLEL_2}, {"latitudeofstandardparallel", TO_PARALLEL_1},
    {"scalefactor", TO_SCALE},           {"scalefactoratnaturalorigin", TO_SCALE}, {"falseeasting", TO_EAST},
    {"eastingatfalseorigin", TO_EAST},   {"falsenorthing", TO_NORTH},              {"northingatfalseorigin", TO_NORTH},
    {"auxiliaryspheretype", TO_NOTHING},
};

static bool take_parameter(const Node *node, double angle, double length, ProjectionParameters *out, bool given[TO_NOTHING + 1]) {
    double *const fields[] = {&out->latitude, &out->longitude, &out->parallels[0], &out->parallels[1], &out->scale, &out->false_east, &out->false_north};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(PARAMETERS); i++) {
        if (strcmp(node->text, PARAMETERS[i].name) != 0) continue;
        ParameterField field = PARAMETERS[i].field;
        given[field] = true;
        if (field != TO_NOTHING && node->number_count)
            *fields[field] = node->numbers[0] * (field <= TO_PARALLEL_2 ? angle : field == TO_SCALE ? 1 : length);
        return true;
    }
    return false;
}

/* Dialects leave out what follows from the rest. */
static void complete(ProjectionParameters *p, const bool given[TO_NOTHING + 1], double pole) {
    if (!given[TO_PARALLEL_2]) p->parallels[1] = p->parallels[0];
    if (p->kind == PROJECTION_LAMBERT_CONFORMAL && !given[TO_PARALLEL_1]) p->parallels[0] = p->parallels[1] = p->latitude;
    if (p->kind == PROJECTION_POLAR_STEREOGRAPHIC) {
        double told = given[TO_PARALLEL_1] ? p->parallels[0] : p->latitude;
        double at = pole != 0 ? pole : told < 0 ? -90 : 90;
        if (fabs(told) < 90 && (!given[TO_SCALE] || p->scale == 1)) {
            p->parallels[0] = p->parallels[1] = told; /* variant B: the parallel of true scale */
            p->scale = 0;
        } else if (p->scale == 0) {
            p->scale = 1;
        }
        p->latitude = at;
    }
}

static int code_of(const Tree *tree, int node) {
    int authority = find_any(tree, node, (const char *const[]){"authority", "id"}, true);
    if (authority < 0 || strcmp(tree->nodes[authority].text, "epsg") != 0) return 0;
    /* AUTHORITY["EPSG","4326"] has the number as a second text, which is not kept: only ISO 19162's ID has a number. */
    return tree->nodes[authority].number_count ? (int)double_clamp(tree->nodes[authority].numbers[0], 0, 1e6) : 0;
}

static bool take_map(const Tree *tree, int projected, double angle, ProjectionParameters *p, StrBuf *error) {
    int method = find_any(tree, projected, (const char *const[]){"projection", "method"}, false);
    const char *name = method >= 0 ? tree->nodes[method].text : "";
    bool given[TO_NOTHING + 1] = {false};
    size_t k = 0;
    while (k < VTS_ARRAY_COUNT(METHODS) && strncmp(name, METHODS[k].name, strlen(METHODS[k].name)) != 0) k++;
    if (k == VTS_ARRAY_COUNT(METHODS)) return map_fail(error, "its projection '%s' is not modelled: convert the map (gdalwarp -t_srs EPSG:4326)", name);
    int unit = find_any(tree, projected, (const char *const[]){"unit", "lengthunit"}, true);
    if (unit < 0) unit = find(tree, projected, "lengthunit", false);
    p->kind = METHODS[k].kind;
    p->unit = number_of(tree, unit, 1);
    for (int i = projected + 1; i < tree->count; i++)
        if (strcmp(tree->nodes[i].name, "parameter") == 0 && !take_parameter(&tree->nodes[i], angle, p->unit, p, given))
            return map_fail(error, "'%s' is no parameter of a projection that is modelled", tree->nodes[i].text);
    complete(p, given, METHODS[k].pole);
    return true;
}

static bool system_of_tree(const Tree *tree, Projection *projection, StrBuf *error) {
    ProjectionParameters p = {.kind = PROJECTION_LONLAT};
    int projected = find_any(tree, -1, (const char *const[]){"projcs", "projcrs"}, false);
    if (projected < 0) projected = find(tree, -1, "projectedcrs", false);
    int datum = find_any(tree, -1, (const char *const[]){"datum", "ensemble"}, false);
    if (datum < 0) datum = find(tree, -1, "geodeticdatum", false);
    if (datum < 0) return map_fail(error, "its text names no datum");
    if (!is_global_datum(tree->nodes[datum].text)) return refuse_datum(error, tree->nodes[datum].text);
    int code = code_of(tree, projected >= 0 ? projected : 0);
    if (code && projection_from_epsg(projection, code, NULL)) return true;
    int ellipsoid = find_any(tree, -1, (const char *const[]){"spheroid", "ellipsoid"}, false);
    if (ellipsoid >= 0 && tree->nodes[ellipsoid].number_count >= 2) {
        p.axis = tree->nodes[ellipsoid].numbers[0];
        p.flattening = tree->nodes[ellipsoid].numbers[1] > 0 ? 1 / tree->nodes[ellipsoid].numbers[1] : 0;
    }
    p.prime_meridian = number_of(tree, find(tree, -1, "primem", false), 0);
    int geographic = find_any(tree, -1, (const char *const[]){"geogcs", "geogcrs"}, false);
    if (geographic < 0) geographic = find_any(tree, -1, (const char *const[]){"basegeogcrs", "geodcrs"}, false);
    int unit = find_any(tree, geographic, (const char *const[]){"unit", "angleunit"}, geographic >= 0);
    double angle = number_of(tree, unit, VTS_RADIANS) / VTS_RADIANS;
    if (projected < 0) p.unit = angle;
    if (fabs(p.unit - 1) < 1e-9) p.unit = 1; /* degrees are written with all kinds of digits */
    if (fabs(angle - 1) < 1e-9) angle = 1;
    return (projected < 0 || take_map(tree, projected, angle, &p, error)) && projection_init(projection, &p, error);
}

/* The word behind a key at the beginning of a line; "" where there is none. */
static void value_of_key(const char *text, const char *end, const char *key, char out[NAME_SIZE]) {
    size_t key_size = strlen(key);
    out[0] = '\0';
    for (const char *line = text; line < end;) {
        const char *stop = memchr(line, '\n', (size_t)(end - line));
        stop = stop ? stop : end;
        while (line < stop && isspace((unsigned char)*line)) line++;
        if ((size_t)(stop - line) > key_size && strncasecmp(line, key, key_size) == 0 && isspace((unsigned char)line[key_size])) {
            const char *value = line + key_size;
            while (value < stop && isspace((unsigned char)*value)) value++;
            bool negative = value < stop && *value == '-';
            out[0] = '-';
            simplify(out + (negative ? 1 : 0), value, size_min((size_t)(stop - value), NAME_SIZE - 2));
            return;
        }
        line = stop + 1;
    }
}

/* "Projection UTM", "Zone 33", "Datum WGS84", "Units METERS", a line each. */
static bool system_of_keywords(const char *text, size_t size, Projection *projection, StrBuf *error) {
    char kind[NAME_SIZE], datum[NAME_SIZE], zone[NAME_SIZE], units[NAME_SIZE];
    value_of_key(text, text + size, "Projection", kind);
    value_of_key(text, text + size, "Datum", datum);
    value_of_key(text, text + size, "Zone", zone);
    value_of_key(text, text + size, "Units", units);
    if (!kind[0]) return map_fail(error, "its text is none that tells a coordinate system");
    if (datum[0] && !is_global_datum(datum)) return refuse_datum(error, datum);
    if (strncmp(kind, "geographic", 10) == 0) {
        projection_lonlat(projection);
        return true;
    }
    int number = atoi(zone);
    bool metres = !units[0] || strncmp(units, "met", 3) == 0;
    if (strcmp(kind, "utm") == 0 && metres && number != 0 && number >= -60 && number <= 60) return projection_utm(projection, abs(number), number > 0);
    return map_fail(error, "its projection '%s' is not modelled from keywords: convert the map (gdalwarp -t_srs EPSG:4326)", kind);
}

bool map_parse_system(const char *text, size_t size, Projection *projection, StrBuf *error) {
    Tree *tree = calloc(1, sizeof *tree);
    if (!tree) return map_fail(error, "not enough memory");
    tree->at = text;
    tree->end = text + size;
    read_tree(tree);
    bool good = tree->count > 0 ? system_of_tree(tree, projection, error) : system_of_keywords(text, size, projection, error);
    free(tree);
    return good;
}
