#include "apps/bench/spirv/module_check.h"

#include <fmt/format.h>
#include <spirv.h>

#include <cstring>
#include <span>

#include "gpu/runtime/kernels/capabilities.h"
#include "host/core/errors.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

constexpr std::size_t k_header_words = 5;
constexpr std::uint32_t k_max_id_bound = 0x3fffff;  // SPIR-V's universal limit
constexpr std::uint32_t k_newest_version = 0x00010600;

std::string_view stage_name(std::uint32_t model) {
    switch (model) {
        case SpvExecutionModelVertex:
            return "a vertex shader";
        case SpvExecutionModelFragment:
            return "a fragment shader";
        case SpvExecutionModelGeometry:
            return "a geometry shader";
        case SpvExecutionModelTessellationControl:
        case SpvExecutionModelTessellationEvaluation:
            return "a tessellation shader";
        case SpvExecutionModelKernel:
            return "an OpenCL kernel";
        default:
            return "of another stage";
    }
}

[[noreturn]] void refuse_module(const std::string& name, const std::string& why) {
    throw ShaderError(fmt::format("{}: {}", name, why));
}

void check_header(const std::string& name, std::span<const std::uint32_t> words) {
    if (words.size() < k_header_words || words[0] != SpvMagicNumber)
        refuse_module(name,
                      "this is no SPIR-V, whose first bytes are 03 02 23 07; compile GLSL with 'glslangValidator -V', "
                      "or name its file .comp");
    if (words[1] > k_newest_version)
        refuse_module(name, fmt::format("it is SPIR-V {}.{}, and Vulkan 1.3 takes up to 1.6; compile it with "
                                        "'--target-env vulkan1.3'",
                                        words[1] >> 16 & 0xff, words[1] >> 8 & 0xff));
    if (words[3] == 0 || words[3] > k_max_id_bound)
        refuse_module(name,
                      fmt::format("its header is damaged: a bound of {} for its ids; compile it again", words[3]));
}

// Returns the text of an instruction from its word `first` on.
std::string text_of(std::span<const std::uint32_t> instruction, std::size_t first) {
    std::string text;
    for (std::size_t i = first; i < instruction.size(); ++i)
        for (unsigned shift = 0; shift < 32; shift += 8) {
            const char letter = static_cast<char>(instruction[i] >> shift & 0xff);
            if (letter == 0) return text;
            text += letter;
        }
    return text;
}

void check_entry_point(const std::string& name, std::span<const std::uint32_t> instruction, std::size_t before) {
    constexpr std::size_t k_first_of_text = 3;
    if (instruction.size() <= k_first_of_text) refuse_module(name, "its entry point has no name; compile it again");
    const std::string entry = without_controls(text_of(instruction, k_first_of_text));
    if (instruction[1] != SpvExecutionModelGLCompute)
        refuse_module(
            name, fmt::format("its entry point '{}' is {}; give a compute shader", entry, stage_name(instruction[1])));
    if (before > 0)
        refuse_module(name, fmt::format("it has another entry point '{}'; give a module with 'main' alone", entry));
    if (entry != "main")
        refuse_module(name, fmt::format("its entry point is called '{}'; it must be called 'main'", entry));
}

void check_capability(const std::string& name, std::uint32_t capability) {
    if (!is_known_capability(capability))
        refuse_module(name,
                      fmt::format("it needs the capability {} of SPIR-V, with which no device is opened; do without",
                                  capability_name(capability)));
}

// Throws unless all instructions end where the next one begins, the last one with the file.
void check_instructions(const std::string& name, std::span<const std::uint32_t> words) {
    std::size_t entry_points = 0;
    for (std::size_t at = k_header_words; at < words.size();) {
        const std::size_t length = words[at] >> 16;
        if (length == 0)
            refuse_module(name,
                          fmt::format("it is damaged: the instruction at byte {} is empty; compile it again", 4 * at));
        if (length > words.size() - at)
            refuse_module(name, fmt::format("it ends within the instruction at byte {}; it is truncated or damaged: "
                                            "copy or compile it again",
                                            4 * at));
        const std::span<const std::uint32_t> instruction = words.subspan(at, length);
        const std::uint32_t operation = words[at] & 0xffff;
        if (operation == SpvOpEntryPoint) check_entry_point(name, instruction, entry_points++);
        if (operation == SpvOpCapability && length > 1) check_capability(name, instruction[1]);
        at += length;
    }
    if (entry_points == 0) refuse_module(name, "it has no entry point; it is truncated, or a library: link it first");
}

}  // namespace

std::vector<std::uint32_t> checked_words(const std::string& name, std::string_view content) {
    std::vector<std::uint32_t> words(content.size() / sizeof(std::uint32_t));
    if (!words.empty()) std::memcpy(words.data(), content.data(), words.size() * sizeof(std::uint32_t));
    check_header(name, words);
    if (content.size() % sizeof(std::uint32_t) != 0)
        refuse_module(name, fmt::format("it has {} bytes, and SPIR-V is of words of four; it is truncated: copy or "
                                        "compile it again",
                                        content.size()));
    check_instructions(name, words);
    return words;
}

void require_capabilities(const UserShader& shader, const Device& device) {
    const std::span<const std::uint32_t> words(shader.words);
    for (std::size_t at = k_header_words; at < words.size(); at += words[at] >> 16) {
        if ((words[at] & 0xffff) != SpvOpCapability || offers_capability(device.physical(), words[at + 1])) continue;
        refuse_module(shader.name,
                      fmt::format("it needs {}, which device '{}' does not offer; choose another with --device",
                                  capability_name(words[at + 1]), device.info().name));
    }
}

}  // namespace exemplar
