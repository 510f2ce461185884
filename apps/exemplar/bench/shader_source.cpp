#include "apps/exemplar/bench/shader_source.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>

#include "apps/exemplar/run_words.h"
#include "gpu/runtime/device/switches.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

constexpr int k_not_installed = 127;

/// A folder that is deleted at the end.
class CompilerFolder {
  public:
    CompilerFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "exemplar-spirv-XXXXXX").string();
        if (!mkdtemp(name.data())) throw DataError(fmt::format("{}: cannot be made; set TMPDIR", name));
        path_ = name;
    }
    ~CompilerFolder() {
        std::error_code error;
        std::filesystem::remove_all(path_, error);
    }
    CompilerFolder(const CompilerFolder&) = delete;
    CompilerFolder& operator=(const CompilerFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

/// Returns the first line that holds `word` in any case, else the first line.
std::string telling_line(const std::string& text, std::string_view word) {
    std::string first;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        std::string line = without_controls(std::string_view(text).substr(begin, end - begin));
        if (lower_case(line).find(word) != std::string::npos) return line;
        if (first.empty()) first = line;
        begin = end + 1;
    }
    return first;
}

std::string compiled_glsl(const std::filesystem::path& path, const std::vector<std::filesystem::path>& includes) {
    const CompilerFolder folder;
    const std::string output = (folder.path() / "shader.spv").string();
    // With 1.3, local sizes from specialization constants would need a feature that devices are opened without.
    std::vector<std::string> words{"glslangValidator", "--quiet", "--target-env", "vulkan1.2", "-S", "comp"};
    if (environment_switches().checks_shaders) words.emplace_back("-g");  // so that messages name lines
    for (const std::filesystem::path& include : includes) words.push_back(fmt::format("-I{}", include.string()));
    words.insert(words.end(), {"-o", output, path.string()});
    const ProgramOutput run = run_words(words);
    if (run.code == k_not_installed)
        throw UsageError(
            fmt::format("{}: GLSL needs glslangValidator, which is not installed (on Debian glslang-tools); "
                        "install it, or give SPIR-V",
                        path.string()));
    if (run.code != 0) {
        std::fputs(run.text.c_str(), stderr);
        throw ShaderError(
            fmt::format("{}: glslangValidator cannot compile it: {}", path.string(), telling_line(run.text, "error")));
    }
    return read_file(output);
}

/// Returns whether spirv-val is installed; throws if it finds a fault.
bool validate(const std::string& name, std::string_view content) {
    const CompilerFolder folder;
    const std::filesystem::path file = folder.path() / "shader.spv";
    write_file_atomically(file, [&](std::ostream& out) { out << content; });
    const ProgramOutput run =
        run_words({"spirv-val", "--target-env", "vulkan1.3", "--scalar-block-layout", file.string()});
    if (run.code == k_not_installed) return false;
    if (run.code == 0) return true;
    throw ShaderError(
        fmt::format("{}: spirv-val refuses it, so no driver is given it: {}", name, telling_line(run.text, "error")));
}

bool is_glsl(const std::filesystem::path& path) {
    return path.extension() == ".comp" || path.extension() == ".glsl";
}

}  // namespace

UserShader load_user_shader(const std::filesystem::path& path, const std::vector<std::filesystem::path>& includes) {
    const std::string name = path.string();
    const std::string source = read_file(path);
    const std::string content = is_glsl(path) ? compiled_glsl(path, includes) : source;
    UserShader shader{.name = name, .words = checked_words(name, content)};
    shader.is_validated = validate(name, content);
    return shader;
}

}  // namespace exemplar
