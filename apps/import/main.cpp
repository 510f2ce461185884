// exemplar-import [--animation] FILE: reads a scene with the Open Asset Import Library and writes it to standard
// output: lines "warning TEXT", then its meshes at rest as a binary PLY file, or with --animation the scene with all
// that moves it as binary glTF (nothing if nothing could move). That library's readers have a history of crashes, so
// they run in this process, whose memory and time are bounded, and not in those that users start. After an error,
// writes one line and returns 1.
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <sys/resource.h>

#include <assimp/Importer.hpp>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <string_view>

#include "apps/import/write.h"
#include "host/core/text.h"

#if defined(__SANITIZE_ADDRESS__)  // GCC
#define EXEMPLAR_ADDRESS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)  // Clang
#define EXEMPLAR_ADDRESS_SANITIZER
#endif
#endif
#ifdef EXEMPLAR_ADDRESS_SANITIZER
/// The library keeps memory for good after errors.
extern "C" int __lsan_is_turned_off() {  // NOLINT: a name of the sanitizer
    return 1;
}
#endif

namespace exemplar::import {
namespace {

constexpr std::uint64_t k_megabyte = std::uint64_t{1} << 20;

/// Bounds memory by 2 GB and 200 times the file, time by a minute and a second for each megabyte.
void bound_this_process(std::uint64_t file_bytes) {
    const rlim_t seconds = 60 + file_bytes / k_megabyte;
    [[maybe_unused]] const rlimit memory{2048 * k_megabyte + 200 * file_bytes, 2048 * k_megabyte + 200 * file_bytes};
    const rlimit time{seconds, seconds + 1}, core{0, 0};
#ifndef EXEMPLAR_ADDRESS_SANITIZER  // which reserves far more
    setrlimit(RLIMIT_AS, &memory);
#endif
    setrlimit(RLIMIT_CPU, &time);
    setrlimit(RLIMIT_CORE, &core);
}

int fail(const std::string& message) {
    std::printf("%s\n", message.c_str());
    return 1;
}

int fail_to_read(const std::string& why) {
    return fail("cannot be read (" + why + "); export it again, or convert it to glTF, OBJ or PLY");
}

bool is_fbx(const std::filesystem::path& path) {
    return exemplar::lower_case(path.extension().string()) == ".fbx";
}

int import_file(const std::string& path, bool with_motion) {
    Assimp::Importer importer;
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                                            aiComponent_COLORS | aiComponent_TEXCOORDS |
                                                            aiComponent_TEXTURES | aiComponent_LIGHTS |
                                                            aiComponent_CAMERAS);
    // Else the library draws bones and cameras of files without meshes.
    importer.SetPropertyInteger(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, 1);
    const aiScene* const source = importer.ReadFile(path, aiProcess_RemoveComponent);
    if (!source || !source->mRootNode) return fail_to_read(importer.GetErrorString());
    // For FBX the library puts 1 in place of the weights at rest of morph targets. They are usually 0.
    const Scene scene = read_scene(*source, !is_fbx(path));
    std::string output;
    for (const std::string& warning : scene.warnings) output += "warning " + warning + "\n";
    if (!with_motion) output += still_ply(scene);
    if (with_motion && has_motion(scene)) output += animated_glb(scene);
    return std::fwrite(output.data(), 1, output.size(), stdout) == output.size() ? 0 : 1;
}

int run(int argc, char** argv) {
    const bool with_motion = argc == 3 && std::string_view(argv[1]) == "--animation";
    if (argc != (with_motion ? 3 : 2)) return fail("usage: exemplar-import [--animation] FILE");
    const char* const path = argv[argc - 1];
    std::error_code ignored;
    const std::uint64_t bytes = std::filesystem::file_size(path, ignored);
    bound_this_process(ignored ? 0 : bytes);
    try {
        return import_file(path, with_motion);
    } catch (const std::bad_alloc&) {
        return fail("reading it takes more memory than a file of its size should; convert it to glTF, OBJ or PLY");
    } catch (const std::exception& error) {
        return fail_to_read(error.what());
    }
}

}  // namespace
}  // namespace exemplar::import

int main(int argc, char** argv) {
    return exemplar::import::run(argc, argv);
}
