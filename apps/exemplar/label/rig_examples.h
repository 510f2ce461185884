#pragma once

#include <filesystem>
#include <vector>

#include "apps/exemplar/commands.h"
#include "host/data/corpus.h"

namespace exemplar {

/// Characters whose bones give labels, for training.
struct RigExamples {
    std::vector<std::filesystem::path> characters;
    std::filesystem::path map, folder;
    std::size_t poses = 4;
};

/// Adds --from-rig, --map, --poses and --export to a subcommand.
void add_rig_example_options(Command& command, RigExamples& examples);

/// Appends the labeled meshes of the characters to a corpus, and writes them to the folder of --export, if there is
/// one. Remarks on bones without a label are printed unless `quiet`.
void add_rig_examples(const RigExamples& examples, bool quiet, LabeledCorpus& corpus);

}  // namespace exemplar
