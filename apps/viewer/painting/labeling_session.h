#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/painting/folder_job.h"
#include "apps/viewer/painting/label_painter.h"
#include "host/labeling/inference/model.h"
#include "host/labeling/painting/labeling_folder.h"
#include "host/mesh/io/io.h"

namespace exemplar {

/// State of a shape as the list shows it.
enum class ShapeState { empty, suggested, verified, broken };

/// A shape of the folder with what the background work found out.
struct SessionShape {
    std::optional<Image> thumbnail;
    std::optional<ShapeDescriptor> descriptor;
    std::optional<float> uncertainty;
    std::vector<std::int32_t> suggestion;  ///< per face of the file; empty: none
    std::string error;
    std::vector<std::int32_t> rejected;  ///< the suggestion that a person rejected; empty: none, or it has changed
};

/// A person who labels the shapes of a folder in the viewer: the palette, the open shape, and the background work that
/// learns from verified shapes.
class LabelingSession {
  public:
    /// Opens a folder of meshes, or one mesh. `model`: suggests labels from the start; null: none. `cache`: of
    /// features. Throws as LabelingFolder.
    LabelingSession(const std::filesystem::path& source, std::filesystem::path cache,
                    std::shared_ptr<const LabelingModel> model = nullptr);

    /// Lets a model suggest labels from now on; its labels join the palette.
    void use_model(std::shared_ptr<const LabelingModel> model);

    /// Opens a shape with its labels, or its strokes, or the suggestion of the model. Throws an Error if it cannot be
    /// read, and keeps the open one. Damaged labels or strokes become remarks.
    void open_shape(std::size_t shape);
    /// Returns the shape that helps most if it is labeled next (see order_by_gain): another than the open one. nullopt
    /// if all others are verified or broken.
    std::optional<std::size_t> next_shape() const;

    std::size_t shape() const { return shape_; }
    LabelPainter& painter() { return *painter_; }
    const LabelPainter& painter() const { return *painter_; }
    const std::filesystem::path& path() const { return folder_.shapes()[shape_].path; }
    const LabelingFolder& folder() const { return folder_; }
    const SessionShape& shape_info(std::size_t shape) const { return shapes_[shape]; }
    ShapeState state_of(std::size_t shape) const;
    /// Changes when a thumbnail does.
    std::uint64_t thumbnail_version() const { return thumbnail_version_; }
    /// Returns suggested shapes that are not verified, most certain first.
    std::vector<std::size_t> to_verify() const;

    // The palette. Each throws UsageError for an impossible name, and keeps the palette.
    const std::vector<PaletteEntry>& palette() const { return folder_.palette(); }
    void add_label(const std::string& name, std::optional<Color> color = std::nullopt);
    void rename_label(std::size_t label, const std::string& name);
    void recolor_label(std::size_t label, const Color& color);

    /// Keeps the strokes in a file, after each of them.
    void keep_strokes();
    /// Saves the shown labels of the open shape, and learns from them. Throws DataError if a face has no label, or the
    /// file cannot be written.
    void verify();
    /// Saves the suggested labels of a shape. Throws DataError likewise.
    void accept(std::size_t shape);
    /// Leaves a shape out of to_verify() until its suggestion has changed (see much_the_same).
    void reject(std::size_t shape) { shapes_[shape].rejected = shapes_[shape].suggestion; }
    /// Starts to learn from what is verified since the last call. Ends earlier work.
    void learn();

    /// Collects results of the background. Call it in each frame. Returns whether anything changed.
    bool poll();
    const FolderJob* job() const { return job_.get(); }
    std::vector<std::string> take_remarks() { return std::exchange(remarks_, {}); }

    PaintSettings settings;
    std::uint64_t settings_version = 0;  ///< increment it when settings or palette change how labels look

  private:
    void change_palette(std::vector<PaletteEntry> palette);
    void add_labels_of(const LabelingModel& model);
    void start_job(bool draws_thumbnails);
    void show_suggestion();
    void collect(ShapeResult result);

    LabelingFolder folder_;
    std::filesystem::path cache_;
    std::vector<SessionShape> shapes_;
    std::size_t shape_ = 0;
    std::unique_ptr<LabelPainter> painter_;
    std::shared_ptr<const LabelingModel> model_;
    std::unique_ptr<FolderJob> job_;
    std::size_t learned_ = 0;  ///< number of verified shapes that the model has seen
    std::uint64_t thumbnail_version_ = 0;
    std::vector<std::string> remarks_;
};

}  // namespace exemplar
