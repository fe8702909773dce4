/* vts_mesh FILE MOST_VERTICES MOST_BYTES: reads a file of meshes through assimp and writes what mesh_stream.h describes to its
 * standard output. A program of its own: damaged files make some of assimp's readers crash, loop or ask for all memory there is. */
#include "shape/mesh_stream.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/BaseImporter.h>

#include <cctype>
#include <climits>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace {

/* Damage makes some readers loop for ever, or take memory for numbers of vertices that the file cannot hold: they get no more of
 * both than a slow reader needs for a file of the size. */
const rlim_t LEAST_SECONDS = 1, BYTES_PER_SECOND = 500000;
const rlim_t LEAST_MEMORY = rlim_t{256} << 20, MEMORY_PER_BYTE = 256;
const char *const known_endings[] = {"obj", "ply", "gltf", "glb", "stl", "off"};

#if defined(__SANITIZE_ADDRESS__)
const bool sanitized = true; /* its shadow memory is larger than any limit */
#else
const bool sanitized = false;
#endif

void limit(decltype(RLIMIT_CPU) resource, rlim_t most) {
    struct rlimit now;
    if (getrlimit(resource, &now) != 0) return;
    if (now.rlim_cur != RLIM_INFINITY && now.rlim_cur < most) most = now.rlim_cur;
    now.rlim_cur = most;
    setrlimit(resource, &now);
}

rlim_t file_size(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 && info.st_size > 0 ? static_cast<rlim_t>(info.st_size) : 0;
}

bool write_all(const void *data, size_t size) {
    const char *bytes = static_cast<const char *>(data);
    while (size > 0) {
        ssize_t n = write(STDOUT_FILENO, bytes, size);
        if (n <= 0) return false;
        bytes += n;
        size -= static_cast<size_t>(n);
    }
    return true;
}

int refuse(const std::string &why) {
    std::string line = why.empty() ? "it cannot be read" : why;
    for (char &c : line)
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    MeshStreamHeader header = {MESH_STREAM_MAGIC, MESH_STREAM_REFUSED, 0, line.size()};
    write_all(&header, sizeof header);
    write_all(line.data(), line.size());
    return 1;
}

/* A file at whose end nobody reads for ever, as assimp's reader of binary PLY does. */
class WatchedFile : public Assimp::IOStream {
public:
    explicit WatchedFile(Assimp::IOStream *file) : file_(file) {}
    size_t Read(void *to, size_t size, size_t count) override {
        size_t n = file_->Read(to, size, count);
        if (n == 0 && ++reads_past_end_ > MOST_READS_PAST_END) throw std::runtime_error("it ends too early");
        return n;
    }
    size_t Write(const void *, size_t, size_t) override { return 0; }
    aiReturn Seek(size_t offset, aiOrigin origin) override { return file_->Seek(offset, origin); }
    size_t Tell() const override { return file_->Tell(); }
    size_t FileSize() const override { return file_->FileSize(); }
    void Flush() override {}

private:
    static const int MOST_READS_PAST_END = 1000;
    std::unique_ptr<Assimp::IOStream> file_;
    int reads_past_end_ = 0;
};

/* Files may name others (materials, buffers): they are read from the folder of the first alone, and from the folders in it. */
class OneFolder : public Assimp::DefaultIOSystem {
public:
    explicit OneFolder(const char *path) {
        char real[PATH_MAX];
        if (realpath(path, real)) folder_ = std::string(real).substr(0, std::strlen(real) - std::strlen(std::strrchr(real, '/')) + 1);
    }
    bool Exists(const char *path) const override { return allows(path) && DefaultIOSystem::Exists(path); }
    Assimp::IOStream *Open(const char *path, const char *mode) override {
        Assimp::IOStream *file = mode[0] == 'r' && allows(path) ? DefaultIOSystem::Open(path, mode) : nullptr;
        return file ? new WatchedFile(file) : nullptr;
    }

    void Close(Assimp::IOStream *file) override { delete file; }

private:
    bool allows(const char *path) const {
        char real[PATH_MAX];
        return !folder_.empty() && realpath(path, real) && std::strncmp(real, folder_.c_str(), folder_.size()) == 0;
    }
    std::string folder_; /* with its slash */
};

bool is_known(const Assimp::BaseImporter *reader) {
    const aiImporterDesc *info = reader ? reader->GetInfo() : nullptr;
    std::istringstream endings(info && info->mFileExtensions ? info->mFileExtensions : "");
    for (std::string ending; endings >> ending;)
        for (const char *known : known_endings)
            if (ending == known) return true;
    return false;
}

/* Assimp guesses by content where the ending does not tell; readers of fifty formats are not wanted for that. */
void keep_known_readers(Assimp::Importer &importer) {
    std::vector<Assimp::BaseImporter *> others;
    for (size_t i = 0; i < importer.GetImporterCount(); i++)
        if (!is_known(importer.GetImporter(i))) others.push_back(importer.GetImporter(i));
    for (Assimp::BaseImporter *reader : others) {
        importer.UnregisterLoader(reader);
        delete reader;
    }
}

/* A mesh where a node places it. */
struct Placed {
    const aiMesh *mesh;
    aiMatrix4x4 place;
};

/* False when there are more than `most` vertices or triangles; *count tells how many then. */
bool collect(const aiScene *scene, uint64_t most, std::vector<Placed> &out, uint64_t *count) {
    struct Visit {
        const aiNode *node;
        aiMatrix4x4 above;
    };
    std::vector<Visit> open = {{scene->mRootNode, aiMatrix4x4()}};
    uint64_t vertices = 0, triangles = 0;
    while (!open.empty()) {
        Visit visit = open.back();
        open.pop_back();
        aiMatrix4x4 place = visit.above * visit.node->mTransformation;
        for (unsigned i = 0; i < visit.node->mNumMeshes; i++) {
            const aiMesh *mesh = scene->mMeshes[visit.node->mMeshes[i]];
            if (mesh->mNumFaces == 0 || !(mesh->mPrimitiveTypes & aiPrimitiveType_TRIANGLE)) continue;
            vertices += mesh->mNumVertices;
            triangles += mesh->mNumFaces;
            *count = vertices > triangles ? vertices : triangles;
            if (*count > most) return false;
            out.push_back({mesh, place});
        }
        for (unsigned i = visit.node->mNumChildren; i-- > 0;) open.push_back({visit.node->mChildren[i], place});
    }
    return true;
}

/* Where the format has no materials, assimp makes them up. */
bool has_materials(const char *path) {
    static const char *const without[] = {".ply", ".stl", ".off"};
    std::string name(path);
    for (char &c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const char *ending : without)
        if (name.size() > 4 && name.compare(name.size() - 4, 4, ending) == 0) return false;
    return true;
}

MeshStreamPart describe(const aiScene *scene, const aiMesh *mesh) {
    MeshStreamPart part = {mesh->mNumVertices, mesh->mNumFaces, 0, 0, {0, 0, 0, 1}};
    if (mesh->HasNormals()) part.flags |= MESH_STREAM_NORMALS;
    if (mesh->HasTextureCoords(0)) part.flags |= MESH_STREAM_UVS;
    if (mesh->mMaterialIndex >= scene->mNumMaterials) return part;
    const aiMaterial *material = scene->mMaterials[mesh->mMaterialIndex];
    aiColor4D color(0, 0, 0, 1);
    float opacity = 1;
    bool made_up = std::strcmp(material->GetName().C_Str(), AI_DEFAULT_MATERIAL_NAME) == 0;
    if (made_up || material->Get(AI_MATKEY_COLOR_DIFFUSE, color) != aiReturn_SUCCESS) return part;
    if (material->Get(AI_MATKEY_OPACITY, opacity) != aiReturn_SUCCESS) opacity = color.a;
    part.flags |= MESH_STREAM_COLOR;
    const float values[4] = {color.r, color.g, color.b, opacity};
    for (int k = 0; k < 4; k++) part.color[k] = static_cast<double>(values[k]);
    return part;
}

size_t part_size(const MeshStreamPart &part) {
    size_t floats = 3u + (part.flags & MESH_STREAM_NORMALS ? 3u : 0u) + (part.flags & MESH_STREAM_UVS ? 2u : 0u);
    return sizeof part + 4 * (floats * part.vertex_count + 3 * size_t{part.triangle_count});
}

class Bytes {
public:
    explicit Bytes(size_t size) { data_.reserve(size); }
    template <typename T> void add(const T &value) {
        const char *bytes = reinterpret_cast<const char *>(&value);
        data_.insert(data_.end(), bytes, bytes + sizeof value);
    }
    bool write_out() const { return write_all(data_.data(), data_.size()); }

private:
    std::vector<char> data_;
};

void add_vector(Bytes &bytes, const aiVector3D &v) {
    bytes.add(v.x);
    bytes.add(v.y);
    bytes.add(v.z);
}

/* Mirrored parts are turned inside out again. */
bool write_part(const aiScene *scene, const Placed &placed) {
    const aiMesh *mesh = placed.mesh;
    MeshStreamPart part = describe(scene, mesh);
    Bytes bytes(part_size(part));
    bytes.add(part);
    for (unsigned i = 0; i < mesh->mNumVertices; i++) add_vector(bytes, placed.place * mesh->mVertices[i]);
    aiMatrix3x3 linear(placed.place), normals(linear);
    normals.Inverse().Transpose();
    for (unsigned i = 0; part.flags & MESH_STREAM_NORMALS && i < mesh->mNumVertices; i++)
        add_vector(bytes, normals * mesh->mNormals[i]);
    for (unsigned i = 0; part.flags & MESH_STREAM_UVS && i < mesh->mNumVertices; i++) {
        bytes.add(mesh->mTextureCoords[0][i].x);
        bytes.add(mesh->mTextureCoords[0][i].y);
    }
    bool mirrored = linear.Determinant() < 0;
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        const aiFace &face = mesh->mFaces[i];
        for (unsigned k = 0; k < 3; k++) {
            uint32_t index = face.mNumIndices == 3 ? face.mIndices[mirrored ? 2 - k : k] : UINT32_MAX;
            bytes.add(index);
        }
    }
    return bytes.write_out();
}

int send(const aiScene *scene, uint64_t most) {
    std::vector<Placed> parts;
    uint64_t count = 0;
    if (!collect(scene, most, parts, &count)) {
        MeshStreamHeader header = {MESH_STREAM_MAGIC, MESH_STREAM_TOO_LARGE, 0, count};
        return !write_all(&header, sizeof header);
    }
    if (parts.empty()) return refuse("it holds no triangles");
    uint64_t size = 0;
    for (const Placed &part : parts) size += part_size(describe(scene, part.mesh));
    MeshStreamHeader header = {MESH_STREAM_MAGIC, MESH_STREAM_READ, static_cast<uint32_t>(parts.size()), size};
    bool ok = write_all(&header, sizeof header);
    for (size_t i = 0; ok && i < parts.size(); i++) ok = write_part(scene, parts[i]);
    return !ok;
}

int read_and_send(const char *path, uint64_t most) {
    Assimp::Importer importer;
    keep_known_readers(importer);
    importer.SetIOHandler(new OneFolder(path));
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const aiScene *scene = importer.ReadFile(path, aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_ValidateDataStructure);
    if (!scene || !scene->mRootNode) return refuse(importer.GetErrorString());
    if (!has_materials(path))
        for (unsigned i = 0; i < scene->mNumMeshes; i++) scene->mMeshes[i]->mMaterialIndex = UINT_MAX;
    return send(scene, most);
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 4) return 2;
    uint64_t most = std::strtoull(argv[2], nullptr, 10), bytes = std::strtoull(argv[3], nullptr, 10);
    const rlim_t size = file_size(argv[1]);
    limit(RLIMIT_CPU, LEAST_SECONDS + size / BYTES_PER_SECOND);
    limit(RLIMIT_CORE, 0);
    if (!sanitized) limit(RLIMIT_AS, LEAST_MEMORY + MEMORY_PER_BYTE * size);
    if (bytes && !sanitized) limit(RLIMIT_AS, bytes);
    try {
        return read_and_send(argv[1], most);
    } catch (const std::exception &error) {
        return refuse(error.what());
    }
}
