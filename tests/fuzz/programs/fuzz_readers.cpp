// fuzz_readers READER [libFuzzer option...] [FILE or FOLDER...]: libFuzzer gives its bytes to one reader.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "tests/fuzz/support/readers.h"

namespace {

const exemplar::fuzz::Reader* reader = nullptr;

[[noreturn]] void explain(const char* program) {
    std::fprintf(stderr, "usage: %s READER [libFuzzer option...] [FILE or FOLDER...]\nREADER is one of", program);
    for (const exemplar::fuzz::Reader& one : exemplar::fuzz::readers())
        std::fprintf(stderr, " %.*s", static_cast<int>(one.name.size()), one.name.data());
    std::fputs("\n", stderr);
    std::exit(2);
}

}  // namespace

// NOLINTBEGIN(readability-identifier-naming): libFuzzer's names
extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
    char** const words = *arguments;
    const auto readers = exemplar::fuzz::readers();
    const auto named = *count < 2
                           ? readers.end()
                           : std::ranges::find(readers, std::string_view(words[1]), &exemplar::fuzz::Reader::name);
    if (named == readers.end()) explain(words[0]);
    reader = &*named;
    // libFuzzer gets the other words.
    std::copy(words + 2, words + *count, words + 1);
    words[--*count] = nullptr;
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    reader->keeps_promises({reinterpret_cast<const char*>(data), size});
    return 0;
}
// NOLINTEND(readability-identifier-naming)
