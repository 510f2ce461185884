#pragma once

#include <span>
#include <string_view>

namespace exemplar::fuzz {

/// A reader of files, and what it promises of any content.
struct Reader {
    std::string_view name;  ///< of its folder corpus/NAME and its words dictionaries/NAME.dict
    /// Reads the content of a file; throws BrokenPromise, or what the reader throws though it should not. Returns
    /// whether the reader accepted the content.
    bool (*keeps_promises)(std::string_view content);
    bool starts_process = false;  ///< whether it needs exemplar-import, and takes 50 ms for a file
};

std::span<const Reader> readers();

}  // namespace exemplar::fuzz
