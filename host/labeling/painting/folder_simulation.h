#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "host/data/corpus.h"
#include "host/labeling/inference/labeler.h"
#include "host/labeling/painting/completion.h"
#include "host/labeling/painting/shape_order.h"
#include "host/labeling/painting/simulated_person.h"
#include "host/labeling/painting/suggestions.h"

namespace exemplar {

/// How the shapes of a folder are labeled.
enum class LabelingWay {
    each_alone,    ///< every shape is painted with completion, in the order of the folder; no model is trained
    random_order,  ///< a model is trained after each shape and suggests the others; shapes come in random order
    order_by_gain  ///< the same, in the order of order_by_gain
};

struct SimulationOptions {
    PersonOptions person;
    PersonCosts costs;
    /// A shape is mended until this share of its surface is right, and accepted in the grid if it is. The simulation
    /// ends when the folder's mean reaches it.
    double quality = 0.95;
    double discarded = 0.5;      ///< a suggestion of which less is right is discarded, and the shape painted anew
    std::size_t rejections = 2;  ///< the person leaves the grid after so many rejected shapes
    std::uint64_t seed = 1;      ///< of training and of the random order
};

/// The folder after one action of the person.
struct SimulationState {
    double seconds = 0;  ///< of the person, from the beginning
    double right = 0;    ///< share of the surface of all shapes, each counted the same, that shows the right label
    std::size_t verified = 0;
    std::size_t strokes = 0;
};

struct SimulationResult {
    std::vector<SimulationState> states;
    /// Returns the person's seconds until a share of the surface is right; the last state's if it never is.
    double seconds_until(double right) const;
};

/// Plays a person who labels the shapes of a folder whose labels are known, through the code that the window uses.
class FolderSimulation {
  public:
    /// `truth`: the shapes with all labels; `features`: of each mesh. Both must outlive this. `progress` is called
    /// with each state.
    FolderSimulation(const LabeledCorpus& truth, std::vector<MeshFeatures>& features, const LabelingBackend& backend,
                     const SimulationOptions& options, std::function<void(const SimulationState&)> progress = {});
    ~FolderSimulation();
    SimulationResult run(LabelingWay way);

  private:
    struct Shape;
    void open_shape(Shape& shape);
    void verify(Shape& shape);
    void mend(Shape& shape);
    void look_through_grid();
    void suggest_all();
    std::size_t choose(LabelingWay way);
    void note(double seconds);

    const LabeledCorpus& truth_;
    std::vector<MeshFeatures>& features_;
    LabelingBackend backend_;
    SimulationOptions options_;
    std::function<void(const SimulationState&)> progress_;
    std::vector<Shape> shapes_;
    ShapeLikeness likeness_;
    std::vector<std::size_t> random_order_;
    SimulationResult result_;
    SimulationState now_;
};

}  // namespace exemplar
