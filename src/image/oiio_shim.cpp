/* The only C++ that touches OpenImageIO; one source for its releases 2.3 to 3.x. Every entry is a function-try-block, so
 * that no exception reaches C. */
#include "image/oiio_shim.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <limits>
#include <memory>
#include <string>
#include <vector>

using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

struct OiioReader {
    std::unique_ptr<ImageInput> input;
    std::deque<std::string> texts; /* a deque: what it holds never moves */
    std::vector<const char *> names;
    std::vector<ImageAttribute> attributes;
};

struct OiioFilm {
    std::unique_ptr<ImageOutput> output;
    ImageSpec spec;
    std::string path;
    bool begun = false;
};

namespace {

/* One line: what OpenImageIO says may be several. */
bool fail(char *error, const std::string &text) {
    std::string line = text.empty() ? "unknown error" : text;
    while (!line.empty() && (line.back() == '\n' || line.back() == '.')) line.pop_back();
    for (char &c : line)
        if (c == '\n' || c == '\r' || c == '\t') c = ' ';
    std::snprintf(error, OIIO_ERROR_SIZE, "%s", line.c_str());
    return false;
}

/* Our own pool does the parallel work. */
void stay_single_threaded() {
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", 1);
}

ImageSample sample_of(TypeDesc type) {
    switch (type.basetype) {
    case TypeDesc::UINT8: return IMAGE_SAMPLE_U8;
    case TypeDesc::INT8: return IMAGE_SAMPLE_I8;
    case TypeDesc::UINT16: return IMAGE_SAMPLE_U16;
    case TypeDesc::INT16: return IMAGE_SAMPLE_I16;
    case TypeDesc::UINT32: return IMAGE_SAMPLE_U32;
    case TypeDesc::INT32: return IMAGE_SAMPLE_I32;
    case TypeDesc::HALF: return IMAGE_SAMPLE_HALF;
    case TypeDesc::DOUBLE: return IMAGE_SAMPLE_DOUBLE;
    default: return IMAGE_SAMPLE_FLOAT;
    }
}

TypeDesc type_of(ImageSample sample) {
    switch (sample) {
    case IMAGE_SAMPLE_U8: return TypeDesc::UINT8;
    case IMAGE_SAMPLE_I8: return TypeDesc::INT8;
    case IMAGE_SAMPLE_U16: return TypeDesc::UINT16;
    case IMAGE_SAMPLE_I16: return TypeDesc::INT16;
    case IMAGE_SAMPLE_U32: return TypeDesc::UINT32;
    case IMAGE_SAMPLE_I32: return TypeDesc::INT32;
    case IMAGE_SAMPLE_HALF: return TypeDesc::HALF;
    case IMAGE_SAMPLE_DOUBLE: return TypeDesc::DOUBLE;
    default: return TypeDesc::FLOAT;
    }
}

const char *keep(OiioReader &reader, const std::string &text) {
    reader.texts.push_back(text);
    return reader.texts.back().c_str();
}

void collect_attributes(OiioReader &reader, const ImageSpec &spec) {
    for (const auto &attribute : spec.extra_attribs) {
        TypeDesc type = attribute.type();
        if (type.aggregate != TypeDesc::SCALAR || type.arraylen != 0 || attribute.nvalues() != 1) continue;
        ImageAttribute out = {keep(reader, attribute.name().string()), nullptr, 0};
        if (type.basetype == TypeDesc::STRING)
            out.text = keep(reader, attribute.get_string());
        else if (type.basetype == TypeDesc::DOUBLE)
            out.number = *static_cast<const double *>(attribute.data());
        else if (type.basetype == TypeDesc::FLOAT || type.basetype == TypeDesc::HALF)
            out.number = static_cast<double>(attribute.get_float());
        else if (type.basetype <= TypeDesc::INT32)
            out.number = attribute.get_int();
        else
            continue;
        reader.attributes.push_back(out);
    }
}

template <typename Sample>
bool read_and_widen(ImageInput &input, const ImageSpec &spec, TypeDesc type, float *pixels) {
    size_t count = static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height) *
                   static_cast<size_t>(spec.nchannels);
    std::vector<Sample> native(count);
    if (!input.read_image(0, 0, 0, spec.nchannels, type, native.data())) return false;
    for (size_t i = 0; i < count; i++) pixels[i] = static_cast<float>(native[i]);
    return true;
}

/* What is stored together: tiles side by side, or scanlines. */
int row_step_of(const ImageSpec &spec) {
    enum { SCANLINES = 16 };
    int step = spec.tile_width > 0 ? spec.tile_height : SCANLINES;
    return step < 1 ? 1 : step < spec.height ? step : spec.height;
}

template <typename Sample>
bool read_rows_and_widen(ImageInput &input, const ImageSpec &spec, int row, int channel, TypeDesc type, float *samples) {
    int first = spec.y + row, end = spec.y + (row + row_step_of(spec) < spec.height ? row + row_step_of(spec) : spec.height);
    size_t count = static_cast<size_t>(spec.width) * static_cast<size_t>(end - first);
    std::vector<Sample> native(count);
    bool good = spec.tile_width > 0 ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, first, end, 0, 1, channel, channel + 1, type, native.data())
                                    : input.read_scanlines(0, 0, first, end, 0, channel, channel + 1, type, native.data());
    for (size_t i = 0; good && i < count; i++) samples[i] = static_cast<float>(native[i]);
    return good;
}

/* Natively, widened here: asked for floats, OpenImageIO would divide integers by their largest value, and asked for
 * integers it would clamp floats. */
bool read_native(ImageInput &input, float *pixels) {
    ImageSpec spec = input.spec();
    TypeDesc type(static_cast<TypeDesc::BASETYPE>(spec.format.basetype));
    switch (sample_of(type)) {
    case IMAGE_SAMPLE_U8: return read_and_widen<unsigned char>(input, spec, type, pixels);
    case IMAGE_SAMPLE_I8: return read_and_widen<signed char>(input, spec, type, pixels);
    case IMAGE_SAMPLE_U16: return read_and_widen<unsigned short>(input, spec, type, pixels);
    case IMAGE_SAMPLE_I16: return read_and_widen<short>(input, spec, type, pixels);
    case IMAGE_SAMPLE_U32: return read_and_widen<unsigned int>(input, spec, type, pixels);
    case IMAGE_SAMPLE_I32: return read_and_widen<int>(input, spec, type, pixels);
    case IMAGE_SAMPLE_DOUBLE: return read_and_widen<double>(input, spec, type, pixels);
    default: return input.read_image(0, 0, 0, spec.nchannels, TypeDesc::FLOAT, pixels);
    }
}

bool read_native_rows(ImageInput &input, int row, int channel, float *samples) {
    ImageSpec spec = input.spec();
    TypeDesc type(static_cast<TypeDesc::BASETYPE>(spec.format.basetype));
    switch (sample_of(type)) {
    case IMAGE_SAMPLE_U8: return read_rows_and_widen<unsigned char>(input, spec, row, channel, type, samples);
    case IMAGE_SAMPLE_I8: return read_rows_and_widen<signed char>(input, spec, row, channel, type, samples);
    case IMAGE_SAMPLE_U16: return read_rows_and_widen<unsigned short>(input, spec, row, channel, type, samples);
    case IMAGE_SAMPLE_I16: return read_rows_and_widen<short>(input, spec, row, channel, type, samples);
    case IMAGE_SAMPLE_U32: return read_rows_and_widen<unsigned int>(input, spec, row, channel, type, samples);
    case IMAGE_SAMPLE_I32: return read_rows_and_widen<int>(input, spec, row, channel, type, samples);
    case IMAGE_SAMPLE_DOUBLE: return read_rows_and_widen<double>(input, spec, row, channel, type, samples);
    default: return read_rows_and_widen<float>(input, spec, row, channel, TypeDesc::FLOAT, samples);
    }
}

std::string attribute_text(const ImageAttribute &attribute) {
    if (attribute.text) return attribute.text;
    char number[32];
    std::snprintf(number, sizeof number, "%.17g", attribute.number);
    return number;
}

/* EXR keeps types; PNG keeps texts; for the rest, lines of the description. */
void add_attributes(ImageSpec &spec, const OiioPicture &picture) {
    std::string format = picture.format, lines;
    for (size_t i = 0; i < picture.attribute_count; i++) {
        const ImageAttribute &attribute = picture.attributes[i];
        if (format == "openexr" && !attribute.text)
            spec.attribute(attribute.name, TypeDesc::DOUBLE, &attribute.number);
        else if (format == "openexr" || format == "png")
            spec.attribute(attribute.name, attribute_text(attribute));
        else
            lines += std::string(attribute.name) + "=" + attribute_text(attribute) + "\n";
    }
    if (!lines.empty()) spec.attribute("ImageDescription", lines);
}

ImageSpec output_spec(const OiioPicture &picture) {
    ImageSpec spec(picture.width, picture.height, picture.channels, type_of(picture.sample));
    std::string format = picture.format;
    for (int c = 0; c < picture.channels; c++) spec.channelnames[static_cast<size_t>(c)] = picture.names[c];
    spec.alpha_channel = picture.alpha;
    if (picture.whole_width > 0) { /* the data window within the display window */
        spec.x = picture.x, spec.y = picture.y;
        spec.full_width = picture.whole_width, spec.full_height = picture.whole_height;
    }
    if (picture.samples) {
        for (int c = 0; c < picture.channels; c++) spec.channelformats.push_back(type_of(picture.samples[c]));
        spec.format = TypeDesc::FLOAT;
    }
    /* These two would otherwise hold the time of writing, and equal pictures be different files. */
    if (format == "openexr" || format == "tiff") spec.attribute("DateTime", "1970:01:01 00:00:00");
    /* Said in a TIFF it becomes an Exif directory, which OpenImageIO 2.4 links in the place of the picture's own; readers
       take integers as sRGB anyway. */
    if (format != "tiff") spec.attribute("oiio:ColorSpace", picture.srgb ? "sRGB" : "Linear");
    if (picture.srgb && picture.alpha >= 0) spec.attribute("oiio:UnassociatedAlpha", 1);
    if (format == "jpeg") spec.attribute("compression", "jpeg:95");
    add_attributes(spec, picture);
    return spec;
}

/* OpenImageIO 2.4 says that it has read tiles of 64-bit floats of a TIFF, and leaves the memory as it was. */
bool tiles_arrive(ImageInput &input, const ImageSpec &spec) {
    if (spec.tile_width <= 0 || spec.format.basetype != TypeDesc::DOUBLE) return true;
    std::vector<unsigned char> tile(spec.tile_bytes(true), 0xA5);
    if (!input.read_native_tile(0, 0, spec.x, spec.y, 0, tile.data())) return true; /* to be told when it is read */
    for (unsigned char byte : tile)
        if (byte != 0xA5) return true;
    return false;
}

ImageSample colour_sample(const ImageSpec &spec) {
    for (size_t c = 0; c < spec.channelformats.size() && c < spec.channelnames.size(); c++)
        if (spec.channelnames[c].size() == 1 && std::strchr("RGBAY", spec.channelnames[c][0])) return sample_of(spec.channelformats[c]);
    return sample_of(spec.format);
}

bool shim_open(const char *path, OiioReader **out, OiioHeader *header, char error[OIIO_ERROR_SIZE]) try {
    stay_single_threaded();
    ImageSpec wish;
    wish.attribute("oiio:UnassociatedAlpha", 1); /* alpha is multiplied in after the sRGB curve, by us */
    auto reader = std::make_unique<OiioReader>();
    reader->input = ImageInput::open(path, &wish);
    if (!reader->input) return fail(error, OIIO::geterror());
    const ImageSpec &spec = reader->input->spec();
    if (spec.deep) return fail(error, "deep pictures are not supported");
    if (spec.depth > 1) return fail(error, "it is a volume, not a picture");
    if (!tiles_arrive(*reader->input, spec)) return fail(error, "this OpenImageIO does not read tiles of 64-bit floats: convert it to 32 bits, or to strips");
    for (const std::string &name : spec.channelnames) reader->names.push_back(keep(*reader, name));
    collect_attributes(*reader, spec);
    std::string space = spec.get_string_attribute("oiio:ColorSpace");
    *header = OiioHeader{};
    header->width = spec.width;
    header->height = spec.height;
    header->channels = spec.nchannels;
    header->names = reader->names.data();
    header->sample = sample_of(spec.format);
    header->colour_sample = colour_sample(spec);
    header->alpha = spec.alpha_channel;
    header->alpha_unassociated = spec.get_int_attribute("oiio:UnassociatedAlpha") != 0 ||
                                 std::strcmp(reader->input->format_name(), "png") == 0;
    header->linear = space == "Linear" || space == "linear" || space.compare(0, 4, "lin_") == 0;
    header->row_step = row_step_of(spec);
    header->attributes = reader->attributes.data();
    header->attribute_count = reader->attributes.size();
    *out = reader.release();
    return true;
} catch (const std::exception &exception) { return fail(error, exception.what()); } catch (...) {
    return fail(error, "");
}

bool shim_read(OiioReader *reader, float *pixels, char error[OIIO_ERROR_SIZE]) try {
    if (read_native(*reader->input, pixels)) return true;
    return fail(error, reader->input->geterror());
} catch (const std::exception &exception) { return fail(error, exception.what()); } catch (...) {
    return fail(error, "");
}

bool shim_read_rows(OiioReader *reader, int row, int channel, float *samples, char error[OIIO_ERROR_SIZE]) try {
    if (read_native_rows(*reader->input, row, channel, samples)) return true;
    return fail(error, reader->input->geterror());
} catch (const std::exception &exception) { return fail(error, exception.what()); } catch (...) {
    return fail(error, "");
}

void shim_close(OiioReader *reader) try { delete reader; } catch (...) {
}

/* Encoded in memory: writing the file, and seeing that writing fails, is done in one place for all formats. */
bool shim_encode(const OiioPicture *picture, void **bytes, size_t *size, char error[OIIO_ERROR_SIZE]) try {
    stay_single_threaded();
    auto output = ImageOutput::create(picture->format);
    if (!output) return fail(error, OIIO::geterror());
    if (!output->supports("ioproxy"))
        return fail(error, "this OpenImageIO cannot write the format to memory");
    OIIO::Filesystem::IOVecOutput file;
    ImageSpec spec = output_spec(*picture);
    void *pointer = static_cast<OIIO::Filesystem::IOProxy *>(&file);
    spec.attribute("oiio:ioproxy", TypeDesc::PTR, &pointer);
    std::string name = std::string("picture.") + picture->format;
    bool done = output->open(name, spec) && output->write_image(type_of(picture->sample), picture->data);
    done = output->close() && done;
    if (!done) return fail(error, output->geterror());
    const std::vector<unsigned char> &buffer = file.buffer();
    *bytes = std::malloc(buffer.size());
    if (!*bytes) return fail(error, "not enough memory");
    std::memcpy(*bytes, buffer.data(), buffer.size());
    *size = buffer.size();
    return true;
} catch (const std::exception &exception) { return fail(error, exception.what()); } catch (...) {
    return fail(error, "");
}

bool shim_film_open(const char *path, const char *format, int width, int height, double fps, OiioFilm **out, char error[OIIO_ERROR_SIZE]) try {
    stay_single_threaded();
    auto film = std::make_unique<OiioFilm>();
    film->output = ImageOutput::create(format);
    if (!film->output) return fail(error, OIIO::geterror());
    if (!film->output->supports("multiimage")) return fail(error, "this OpenImageIO cannot write several pictures into one file");
    film->spec = ImageSpec(width, height, 3, TypeDesc::UINT8);
    film->spec.attribute("FramesPerSecond", static_cast<float>(fps));
    film->spec.attribute("oiio:Movie", 1);
    film->path = path;
    *out = film.release();
    return true;
} catch (const std::exception &exception) { return fail(error, exception.what()); } catch (...) {
    return fail(error, "");
}

bool shim_film_add(OiioFilm *film, const unsigned char *pixels, char error[OIIO_ERROR_SIZE]) try {
    ImageOutput::OpenMode mode = film->begun ? ImageOutput::AppendSubimage : ImageOutput::Create;
    film->begun = true;
    if (film->output->open(film->path, film->spec, mode) && film->output->write_image(TypeDesc::UINT8, pixels)) return true;
    return fail(error, film->output->geterror());
} catch (const std::exception &exception) { return fail(error, exception.what()); } catch (...) {
    return fail(error, "");
}

bool shim_film_close(OiioFilm *film, char error[OIIO_ERROR_SIZE]) try {
    std::unique_ptr<OiioFilm> owned(film);
    return film->output->close() || fail(error, film->output->geterror());
} catch (const std::exception &exception) { return fail(error, exception.what()); } catch (...) {
    return fail(error, "");
}

const OiioShim shim = {OIIO_SHIM_VERSION, shim_open, shim_read, shim_read_rows, shim_close, shim_encode,
                       shim_film_open, shim_film_add, shim_film_close};

} // namespace

const OiioShim *vts_oiio_shim(void) { return &shim; }
