#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/exemplar/commands.h"
#include "host/mesh/io/io.h"
#include "host/parts/rigging/make_rig.h"

namespace exemplar {

/// The arguments of commands that work on one labeled mesh: a model and a mesh, or a mesh with labels.
struct LabeledInputArguments {
    std::vector<std::filesystem::path> paths;
    std::filesystem::path labels, cache;
};

/// A mesh file and a label per triangle.
struct LabeledInput {
    std::filesystem::path path;  ///< of the mesh
    MeshFile file;
    std::vector<std::string> names;
    std::vector<std::int32_t> label;    ///< per triangle, index into `names`
    std::vector<double> compatibility;  ///< labels x labels, of the model (Eq. 3.3); empty without a model
    std::string source;                 ///< where the labels are from, for messages and reports
};

/// Returns how unlikely it is that parts of two labels touch, by the compatibilities of the model; nothing without one.
LabelPairCosts pair_costs(const LabeledInput& input);

/// Adds the argument "[MODEL] MESH", --labels, --cache and --device to a subcommand.
void add_labeled_input(Command& command, LabeledInputArguments& arguments, CommonOptions& common);

/// Reads the mesh. Its labels are, in this order: those that the model gives it, those of --labels, NAME_labels.txt
/// beside it, those in the mesh file. Throws UsageError for more than two paths or a model with --labels, DataError if
/// there are no labels.
LabeledInput read_labeled_input(const LabeledInputArguments& arguments, const CommonOptions& common);

}  // namespace exemplar
