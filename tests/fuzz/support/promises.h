#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "host/animation/animation.h"
#include "host/curvature/model/model.h"
#include "host/mesh/io/io.h"
#include "tests/fuzz/support/allocation.h"

namespace exemplar::fuzz {

/// A reader or writer did not do what its description promises. Ends a libFuzzer program, fails a GoogleTest.
class BrokenPromise : public std::logic_error {
  public:
    using std::logic_error::logic_error;
};

/// Throws BrokenPromise with `promise` unless it was kept.
void require(bool kept, std::string_view promise);
/// Errors and warnings are one short line of printable UTF-8.
void require_readable(std::string_view message);
/// Indices in range, labels that fit the faces and have names that every writer takes, readable warnings; and
/// validate_mesh and require_usable agree with what the vertices are.
void require_promises(const MeshFile& file);

/// What Rig says of its lists, indices in range, readable warnings; and posed vertices for each frame of a clip.
void require_promises(const Animation& animation);

/// Gives curvature on surfaces of its vertex count, and on a rig that it fits, without touching what is not its own;
/// says in a readable error what it does not fit.
void require_promises(const CurvatureModel& model);

/// The most memory that reading may take at any time: `fixed` plus `per_byte` times the size of the file.
struct MemoryBound {
    std::size_t fixed, per_byte;
};

/// Calls `read` on a file of `size` bytes; returns whether it was accepted, that is, did not throw E. Any other
/// exception passes. Requires that an E begins with `name` and is readable, and that memory stays within `bound`.
template <typename E, typename Read>
bool accepts(std::string_view name, std::size_t size, MemoryBound bound, Read&& read) {
    const std::size_t before = live_bytes();
    reset_peak();
    bool accepted = true;
    std::string message;
    try {
        read();
    } catch (const E& error) {
        accepted = false;
        message = error.what();
    }
    const std::size_t used = peak_bytes() - before;
    require(used <= bound.fixed + bound.per_byte * size,
            "little memory: " + std::to_string(used) + " bytes for a file of " + std::to_string(size));
    if (accepted) return true;
    require(message.starts_with(name), "an error that begins with the file's name: " + message);
    require_readable(std::string_view(message).substr(name.size()));
    return false;
}

}  // namespace exemplar::fuzz
