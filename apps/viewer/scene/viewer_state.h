#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/viewer/controls/frame_times.h"
#include "apps/viewer/controls/orbit_camera.h"
#include "apps/viewer/controls/playback.h"
#include "apps/viewer/controls/pose_controls.h"
#include "apps/viewer/controls/shortcuts.h"
#include "apps/viewer/controls/training_job.h"
#include "apps/viewer/painting/labeling_session.h"
#include "apps/viewer/scene/document.h"
#include "apps/viewer/scene/hatching_job.h"
#include "apps/viewer/scene/messages.h"
#include "apps/viewer/scene/view_settings.h"
#include "host/curvature/model/model.h"

namespace exemplar {

/// State of the viewer on the host, with or without a window. The data on the device is derived from it.
class ViewerState {
  public:
    /// Opens a file of any kind: mesh, animation, model or style of hatching (.safetensors), style of lines (.json),
    /// labels (_labels.txt, .seg). Throws an Error if that fails, and keeps what was open.
    void open(const std::filesystem::path& path, ViewSize view);
    /// Opens a model of any file name. Throws ModelError if it is none, or does not fit the document.
    void open_model(const std::filesystem::path& path);
    /// Opens a style of hatching. Throws ModelError if the file is none.
    void open_hatching(const std::filesystem::path& path);
    void close();
    void set_clip(std::size_t clip);
    void set_model(std::shared_ptr<const CurvatureModel> model, std::string name);
    /// Fits the camera to everything that the current clip covers.
    void fit(ViewSize view);
    /// Performs an action of a key. Returns false for actions that concern the window, which it does not perform.
    bool perform(Action action, ViewSize view);

    /// Starts to learn curvature from the frames of the document; from random expressions if it has none. Throws
    /// UsageError if there is too little to learn from.
    void start_training();
    /// Sets the learned model, if training is done.
    void collect_training();

    /// Starts to draw a hatched still of that size, on a device of that name, for those files; does nothing while
    /// another is being drawn. Throws UsageError if no style of hatching is open.
    void start_hatching(ViewSize size, const std::string& device, StillNames names);
    /// Shows a message on the written files, if drawing is done.
    void collect_hatching();

    /// Starts to label the shapes of a folder, or one mesh, and opens the first. `model`: of 'exemplar label train';
    /// empty: none. Throws an Error if that fails, and keeps what was open.
    void start_labeling(const std::filesystem::path& source, const std::filesystem::path& model, ViewSize view);
    /// Opens a shape of the folder that is being labeled. Throws an Error if that fails, and keeps the open one.
    void open_shape(std::size_t shape, ViewSize view);
    /// Collects what the background of labeling has found out, and shows it. Returns whether anything changed.
    bool collect_labeling();
    /// Turns the view to the next place whose labels are uncertain; remarks that there is none.
    void show_uncertain_place();
    /// Verifies the open shape and opens the next. Shows a message if that fails.
    void verify_shape(ViewSize view);
    /// Runs an edit of labels; an Error of it becomes a message.
    void try_labeling(const std::function<void()>& edit);

    bool has_document() const { return document_ != nullptr; }
    const Document& document() const { return *document_; }
    /// Change whenever the document, or the model, changes.
    std::uint64_t document_version() const { return document_version_; }
    std::uint64_t model_version() const { return model_version_; }
    std::size_t clip() const { return clip_; }
    std::shared_ptr<const CurvatureModel> model() const { return model_; }
    const std::string& model_name() const { return model_name_; }
    std::shared_ptr<const HatchingStyle> hatching() const { return hatching_; }
    const std::string& hatching_name() const { return hatching_name_; }
    /// The shape at the current frame, with the changes of sliders.
    SurfaceShape shape() const;

    /// Whether learned and estimated curvature are shown side by side.
    bool shows_both() const {
        return document_ && model_ && settings.source == ShownCurvature::both && settings.needs_curvature();
    }

    Playback playback;
    PoseControls pose;
    OrbitCamera camera;
    ViewSettings settings;
    Messages messages;
    FrameTimes times;
    std::unique_ptr<TrainingJob> training;
    std::unique_ptr<HatchingJob> hatching_job;
    std::unique_ptr<LabelingSession> labeling;  ///< null: labels are not painted
    bool show_grid = false;                     ///< of the shapes that are being labeled
    bool show_panels = true, show_help = false, show_times = false;

  private:
    void open_document(const std::filesystem::path& path, ViewSize view);
    void open_labels(const std::filesystem::path& path);
    void show_document(std::unique_ptr<Document> document, ViewSize view);
    void show_labels();
    void perform_labeling(Action action, ViewSize view);
    void edit_strokes(Action action);
    void check_first_suggestion(Action action, ViewSize view);
    std::unique_ptr<Document> document_;  // scenes refer to it
    std::uint64_t document_version_ = 0, model_version_ = 0;
    std::size_t clip_ = 0;
    std::uint64_t shown_labels_ = 0;  ///< version of the painter's labels that the document has
    std::shared_ptr<const CurvatureModel> model_;
    std::string model_name_;
    std::shared_ptr<const HatchingStyle> hatching_;
    std::string hatching_name_;
};

}  // namespace exemplar
