// What libFuzzer calls. The program's name, fuzz_READER, says which reader gets the bytes.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "tests/fuzz/readers.h"

namespace {

const exemplar::fuzz::Reader* reader = nullptr;

}  // namespace

// NOLINTBEGIN(readability-identifier-naming): libFuzzer's names
extern "C" int LLVMFuzzerInitialize(int*, char*** arguments) {
    const std::string_view program = **arguments;
    reader = &exemplar::fuzz::reader_of(program.substr(program.rfind("fuzz_") + 5));
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    reader->keeps_promises({reinterpret_cast<const char*>(data), size});
    return 0;
}
// NOLINTEND(readability-identifier-naming)
