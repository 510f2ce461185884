// exemplar-import FILE: reads a mesh with the Open Asset Import Library and writes it to standard output, as lines
// "warning TEXT" and a binary PLY file. That library's readers have a history of crashes, so they run in this process,
// whose memory and time are bounded, and not in those that users start. After an error, writes one line and returns 1.
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <sys/resource.h>

#include <array>
#include <assimp/Importer.hpp>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr std::uint64_t k_megabyte = std::uint64_t{1} << 20;

/// Bounds memory by 2 GB and 200 times the file, time by a minute and a second for each megabyte.
void bound_this_process(std::uint64_t file_bytes) {
    const rlim_t seconds = 60 + file_bytes / k_megabyte;
    const rlimit memory{2048 * k_megabyte + 200 * file_bytes, 2048 * k_megabyte + 200 * file_bytes};
    const rlimit time{seconds, seconds + 1}, core{0, 0};
#ifndef __SANITIZE_ADDRESS__  // which reserves far more
    setrlimit(RLIMIT_AS, &memory);
#endif
    setrlimit(RLIMIT_CPU, &time);
    setrlimit(RLIMIT_CORE, &core);
}

template <typename T>
void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

/// The faces of a scene, as the rows of a PLY file.
class SceneWriter {
  public:
    explicit SceneWriter(const aiScene& scene) : scene_(scene) {}

    std::string write() {
        add_node(*scene_.mRootNode, aiMatrix4x4t<double>(), 0);
        std::string output;
        if (left_out_) output += "warning " + std::to_string(left_out_) + " points or lines were left out\n";
        if (skins_)
            output += "warning the skins of " + std::to_string(skins_) + " meshes were left out; they are at rest\n";
        return output + "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices_) +
               "\nproperty double x\nproperty double y\nproperty double z\nelement face " + std::to_string(faces_) +
               "\nproperty list uint uint vertex_indices\nend_header\n" + positions_ + corners_;
    }
    bool has_faces() const { return faces_ > 0; }

  private:
    static constexpr int k_deepest = 1000;

    void add_node(const aiNode& node, const aiMatrix4x4t<double>& parent, int depth) {
        if (depth > k_deepest) throw std::runtime_error("its nodes are nested too deep");
        const aiMatrix4x4t<double> transform = parent * aiMatrix4x4t<double>(node.mTransformation);
        for (unsigned i = 0; i < node.mNumMeshes; ++i) add_mesh(*scene_.mMeshes[node.mMeshes[i]], transform);
        for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(*node.mChildren[i], transform, depth + 1);
    }
    void add_mesh(const aiMesh& mesh, const aiMatrix4x4t<double>& transform) {
        const bool mirrored = transform.Determinant() < 0;  // such a transform reverses every face
        const auto first = static_cast<std::uint32_t>(vertices_);
        if (mesh.mNumBones > 0) ++skins_;
        for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
            const aiVector3D& p = mesh.mVertices[v];
            const aiVector3t<double> q = transform * aiVector3t<double>(p.x, p.y, p.z);
            for (const double coordinate : {q.x, q.y, q.z}) append(positions_, coordinate);
        }
        vertices_ += mesh.mNumVertices;
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            if (face.mNumIndices < 3) {
                ++left_out_;
                continue;
            }
            append(corners_, std::uint32_t{face.mNumIndices});
            for (unsigned i = 0; i < face.mNumIndices; ++i)
                append(corners_, first + face.mIndices[mirrored ? face.mNumIndices - 1 - i : i]);
            ++faces_;
        }
    }

    const aiScene& scene_;
    std::string positions_, corners_;
    std::uint64_t vertices_ = 0, faces_ = 0, left_out_ = 0, skins_ = 0;
};

int fail(const std::string& message) {
    std::printf("%s\n", message.c_str());
    return 1;
}

int fail_to_read(const std::string& why) {
    return fail("cannot be read (" + why + "); export it again, or convert it to glTF, OBJ or PLY");
}

int import_file(const std::string& path) {
    Assimp::Importer importer;
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                                            aiComponent_COLORS | aiComponent_TEXCOORDS |
                                                            aiComponent_TEXTURES | aiComponent_ANIMATIONS |
                                                            aiComponent_LIGHTS | aiComponent_CAMERAS);
    const aiScene* const scene = importer.ReadFile(path, aiProcess_RemoveComponent);
    if (!scene || !scene->mRootNode) return fail_to_read(importer.GetErrorString());
    SceneWriter writer(*scene);
    const std::string output = writer.write();
    if (!writer.has_faces()) return fail("no node has a mesh with faces; export it again with its surface");
    return std::fwrite(output.data(), 1, output.size(), stdout) == output.size() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return fail("usage: exemplar-import FILE");
    std::error_code ignored;
    const std::uint64_t bytes = std::filesystem::file_size(argv[1], ignored);
    bound_this_process(ignored ? 0 : bytes);
    try {
        return import_file(argv[1]);
    } catch (const std::bad_alloc&) {
        return fail("reading it takes more memory than a file of its size should; convert it to glTF, OBJ or PLY");
    } catch (const std::exception& error) {
        return fail_to_read(error.what());
    }
}
