// exemplar label next: says which shape of a folder to label next.

#include <fmt/format.h>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/backend.h"
#include "apps/exemplar/commands.h"
#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/core/text.h"
#include "host/labeling/category/descriptor_cache.h"
#include "host/labeling/features/feature_cache.h"
#include "host/labeling/painting/folder_learning.h"
#include "host/labeling/painting/shape_order.h"
#include "host/labeling/painting/suggestions.h"

namespace exemplar {
namespace {

struct NextOptions {
    CommonOptions common;
    std::filesystem::path folder;
    std::filesystem::path cache = default_feature_folder();
    std::size_t count = 10;
};

/// A shape that may be labeled next.
struct WaitingShape {
    std::filesystem::path path;
    ShapeDescriptor descriptor;
    float uncertainty = 1;  ///< 0 for verified shapes
    bool suggested = false;
};

std::vector<std::string> names_of(const std::vector<PaletteEntry>& palette) {
    std::vector<std::string> names;
    names.reserve(palette.size());
    for (const PaletteEntry& entry : palette) names.push_back(entry.name);
    return names;
}

/// Describes all shapes, and labels those that are not verified if there is a model. Broken shapes are left out, with
/// a warning.
std::vector<WaitingShape> describe_folder(const LabelingFolder& folder, const LabelingModel* model,
                                          const LabelingBackend& backend, const std::filesystem::path& cache) {
    std::vector<WaitingShape> shapes;
    const std::vector<std::string> palette = names_of(folder.palette());
    Progress progress("measuring shapes", folder.shapes().size());
    for (const FolderShape& shape : folder.shapes()) {
        check_interrupt();
        try {
            WaitingShape waiting;
            waiting.path = shape.path;
            if (model && !shape.verified) {
                SuggestedShape suggested = suggest_shape(*model, shape.path, palette, cache, backend);
                waiting.uncertainty = suggested.uncertainty;
                waiting.descriptor = std::move(suggested.descriptor);
                waiting.suggested = true;
            } else {
                waiting.descriptor =
                    cached_shape_descriptor(read_mesh(shape.path).mesh, suggestion_training().features, cache);
                if (shape.verified) waiting.uncertainty = 0;
            }
            shapes.push_back(std::move(waiting));
        } catch (const MeshError& error) {
            fmt::print(stderr, "warning: {}\n", error.what());
        }
        progress.advance(1, shape.path.filename().string());
    }
    return shapes;
}

void run_next(const NextOptions& options) {
    const auto limits = apply_common_options(options.common);
    const std::filesystem::path cache = usable_cache(options.cache, options.common.quiet);
    const LabelingFolder folder(options.folder);
    DeviceBackend backend(options.common.device);
    const auto model = learn_from_verified(folder.shapes(), cache, backend.labeling());
    const std::vector<WaitingShape> shapes = describe_folder(folder, model.get(), backend.labeling(), cache);
    std::vector<ShapeDescriptor> descriptors;
    std::vector<float> uncertainty;
    for (const WaitingShape& shape : shapes) {
        descriptors.push_back(shape.descriptor);
        uncertainty.push_back(shape.uncertainty);
    }
    const std::vector<std::size_t> order =
        order_by_gain(ShapeLikeness(descriptors), uncertainty, folder.palette().size());
    nlohmann::json json = nlohmann::json::array();
    for (const std::size_t s : order) {
        json.push_back({{"mesh", shapes[s].path.string()}, {"uncertainty", shapes[s].uncertainty}});
        if (json.size() > options.count && options.count > 0) continue;
        fmt::print("{}", shapes[s].path.string());
        if (shapes[s].suggested) fmt::print("  {:.0f} % uncertain", 100 * static_cast<double>(shapes[s].uncertainty));
        fmt::print("\n");
    }
    if (order.empty()) fmt::print("all {} are verified\n", counted(shapes.size(), "shape"));
    write_report(options.common, {{"verified", folder.verified_count()}, {"order", json}});
}

}  // namespace

void add_next_command(Command& label) {
    auto options = std::make_shared<NextOptions>();
    Command* command = label.add_subcommand("next", "Says which shape of a folder to label next");
    command->footer(
        "The first shape is the one that helps most: its own labels and those of the shapes like it are least "
        "certain,\n"
        "by a model of the shapes that have labels. The window of 'exemplar-viewer FOLDER --label' uses the same "
        "order.\n\n"
        "Example:\n  exemplar label next shapes --count 3");
    command->add_option("FOLDER", options->folder, "folder of meshes, of which some have NAME_labels.txt")
        ->required()
        ->type_name("");
    command->add_option("--count", options->count, "shapes to print; 0 prints all")->capture_default_str();
    command->add_option("--cache", options->cache, "folder that remembers features; '' remembers none")
        ->capture_default_str()
        ->type_name("FOLDER");
    add_device_option(*command, options->common);
    add_common_options(*command, options->common);
    command->callback([options] { run_next(*options); });
}

}  // namespace exemplar
