#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/controls/background_job.h"
#include "host/imaging/image.h"
#include "host/labeling/category/shape_descriptor.h"
#include "host/labeling/inference/model.h"
#include "host/labeling/painting/labeling_folder.h"

namespace exemplar {

/// Results of the background work for one shape of a folder.
struct ShapeResult {
    std::size_t shape = 0;
    std::optional<Image> thumbnail{};             ///< RGB
    std::optional<ShapeDescriptor> descriptor{};  ///< once its features are computed
    std::optional<float> uncertainty{};           ///< of the suggested labels
    std::vector<std::int32_t> label{};            ///< suggested, per face of the file: indices into the palette
    std::string error{};                          ///< why the shape cannot be labeled
};

/// Input of the work: the folder as it was when the work began.
struct FolderWork {
    std::vector<FolderShape> shapes;
    std::vector<PaletteEntry> palette;
    std::vector<bool> described;  ///< shapes whose descriptor is known already
    std::filesystem::path cache, model_file;
    bool draws_thumbnails = true;
};

/// Learns from the verified shapes of a folder and labels the others, in the background, on one core and at low
/// priority, so that painting goes on. First draws all thumbnails, then trains, then labels. Without a model it
/// measures the shapes all the same, for their order. The result is the model; null if there is nothing to learn from
/// yet. The model is also written to a file.
class FolderJob final : public BackgroundJob<std::shared_ptr<const LabelingModel>> {
  public:
    static constexpr int k_thumbnail_width = 144, k_thumbnail_height = 108;  ///< pixels

    explicit FolderJob(FolderWork work);
    ~FolderJob();

    struct Status {
        std::string what;  ///< current step, a present participle
        float share = 0;   ///< of that step, in [0, 1]
    };
    Status status() const;
    /// Returns what was found since the last call.
    std::vector<ShapeResult> take_results();

  private:
    std::shared_ptr<const LabelingModel> run();
    void draw_thumbnails();
    void describe_shapes(bool only_verified);
    std::shared_ptr<const LabelingModel> train();
    void suggest(const LabelingModel& model);
    void post(ShapeResult result);
    void set_status(const char* what, std::size_t done, std::size_t total);
    std::vector<std::string> palette_names() const;

    FolderWork work_;
    mutable std::mutex mutex_;
    Status status_{.what = "beginning"};
    std::vector<ShapeResult> results_;
};

}  // namespace exemplar
