#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "host/data/catalog/catalog.h"

namespace exemplar {

/// How shapes are added to a catalog.
struct AddOptions {
    std::string category;             ///< of all shapes; empty: none
    bool category_of_folder = false;  ///< the category of each is the name of its folder
    bool named_after_source = true;   ///< results lie in a folder named after the folder that was added
    std::size_t memory = 0;           ///< bytes that reading may take; 0: see usable_memory
    bool quiet = false;
};

/// Outcomes of the files that were found.
struct AddCounts {
    std::size_t found = 0, fresh = 0, unchanged = 0, unusable = 0;
};

/// Adds the meshes of folders (recursively), lists and mesh files. Usable meshes that the catalog knows and that
/// have not changed are not read again. If it is interrupted, a part has been added, and the next call continues.
AddCounts add_to_catalog(Catalog& catalog, const std::vector<std::filesystem::path>& sources,
                         const AddOptions& options);
/// Reads the unusable shapes of a catalog again.
AddCounts retry_unusable(Catalog& catalog, const AddOptions& options);

}  // namespace exemplar
