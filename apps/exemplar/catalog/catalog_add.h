#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "host/data/catalog/catalog.h"

namespace exemplar {

/// How shapes are added to a catalog.
struct AddOptions {
    std::string category;             ///< of all of them; empty: they have none
    bool category_of_folder = false;  ///< the category of each is the name of its folder
    bool named_after_source = true;   ///< results lie in a folder named after the folder that was added
    std::size_t memory = 0;           ///< bytes that reading may take; 0: see usable_memory
    bool quiet = false;
};

/// What became of the files that were found.
struct AddCounts {
    std::size_t found = 0, fresh = 0, unchanged = 0, unusable = 0;
};

/// Adds the meshes of folders (and below), lists and mesh files; those that a catalog knows, that can be used and that
/// have not changed are not read again. Ended at any moment, it has added a part, and goes on when called again.
AddCounts add_to_catalog(Catalog& catalog, const std::vector<std::filesystem::path>& sources,
                         const AddOptions& options);
/// Reads those again that could not be used.
AddCounts look_at_unusable(Catalog& catalog, const AddOptions& options);

}  // namespace exemplar
