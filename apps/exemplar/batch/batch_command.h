#pragma once

#include <cstddef>
#include <filesystem>

#include "apps/exemplar/batch/batch_slurm.h"
#include "apps/exemplar/commands.h"
#include "host/labeling/features/feature_cache.h"

namespace exemplar {

/// Arguments of `exemplar label batch`.
struct BatchCommand {
    CommonOptions common;
    std::filesystem::path source, model, models, out;
    std::filesystem::path cache = default_feature_folder();
    double memory = 0;
    std::size_t group = 8, tasks = 0;
    bool gltf = false, keep_small = false, retry = false;
    bool slurm = false, wait = false;
    SlurmOptions slurm_options;
};

/// Returns an absolute path, which is valid in any working folder.
inline std::filesystem::path whole_path(const std::filesystem::path& path) {
    return std::filesystem::absolute(path).lexically_normal();
}

}  // namespace exemplar
