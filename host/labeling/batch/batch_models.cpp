#include "host/labeling/batch/batch_models.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/data/catalog/shape_scan.h"
#include "host/data/safetensors.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

/// Returns whether a file holds a model that recognizes categories. False if it holds no model at all: load_model
/// reports that.
bool is_category_model(const fs::path& path) {
    try {
        const auto metadata = map_safetensors(path).metadata;
        const auto kind = metadata.find("kind");
        return kind != metadata.end() && kind->second == k_category_model_kind;
    } catch (const ModelError&) {
        return false;
    }
}

std::vector<fs::path> model_files(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
        if (it->path().extension() == ".safetensors") files.push_back(it->path());
    if (files.empty())
        throw DataError(
            fmt::format("{}: holds no models (.safetensors); make them with 'exemplar label train'", folder.string()));
    std::ranges::sort(files, natural_less, [](const fs::path& path) { return path.string(); });
    return files;
}

void add_recognizer(BatchModels& models, const fs::path& path) {
    if (models.recognizer)
        throw ModelError(
            fmt::format("{}: is a second model that recognizes categories; leave one in the folder", path.string()));
    models.recognizer = load_category_model(path);
    models.recognizer_hash = file_hash(path);
}

bool same_features(const FeatureOptions& a, const FeatureOptions& b) {
    return a.samples == b.samples;
}

void require_same_features(const BatchModels& models) {
    for (const BatchModel& model : models.models)
        if (!same_features(model.model.feature_options, models.features))
            throw ModelError(fmt::format("{}: wants other features (--samples) than {}; train both alike", model.name,
                                         models.models.front().name));
    if (models.recognizer && !same_features(models.recognizer->feature_options, models.features))
        throw ModelError(
            fmt::format("the model that recognizes categories wants other features (--samples) than {}; "
                        "train both alike",
                        models.models.front().name));
}

}  // namespace

const BatchModel* BatchModels::of_category(const std::string& category) const {
    const auto found =
        std::ranges::find_if(models, [&](const auto& model) { return lower_case(model.name) == lower_case(category); });
    return found == models.end() ? nullptr : &*found;
}

std::string BatchModels::key() const {
    std::string key = is_single_model ? "all" : recognizer_hash;
    for (const BatchModel& model : models) key += fmt::format(" {}:{}", model.name, model.hash);
    return key;
}

BatchModels load_batch_models(const fs::path& path) {
    BatchModels models;
    std::error_code ignored;
    const bool folder = fs::is_directory(path, ignored);
    models.is_single_model = !folder;
    for (const fs::path& file : folder ? model_files(path) : std::vector{path}) {
        if (folder && is_category_model(file))
            add_recognizer(models, file);
        else
            models.models.push_back({file.stem().string(), file_hash(file), load_model(file)});
    }
    if (models.models.empty())
        throw DataError(fmt::format("{}: holds no model that labels; make one per category with 'exemplar label train'",
                                    path.string()));
    models.features = models.models.front().model.feature_options;
    require_same_features(models);
    return models;
}

}  // namespace exemplar
