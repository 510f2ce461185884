#include "apps/exemplar/bench/spirv_job.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "apps/exemplar/bench/shader_source.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

using Constants = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

bool has_constant(const ShaderScalars& scalars, std::uint32_t id) {
    return std::ranges::find(scalars.constants, id, &ReflectedConstant::id) != scalars.constants.end();
}

void set_constants(Constants& constants, const std::string& option, const std::vector<std::string>& texts,
                   const ShaderScalars& scalars, const ShaderScalars* others) {
    for (const std::string& text : texts) {
        const ConstantText constant = parse_constant(option, text);
        // One --spec serves both shaders; it may be a constant of the other shader alone.
        if (others && !has_constant(scalars, constant.id) && has_constant(*others, constant.id)) continue;
        const auto bits = constant_bits(option, constant, scalars.constants);
        std::erase_if(constants, [&](const auto& known) { return known.first == bits.first; });
        constants.push_back(bits);
    }
}

void set_size(UserDispatch& dispatch, const SpirvOptions& options, bool is_other) {
    const bool own = is_other && !options.against_groups.empty();
    dispatch.size_is_groups = own || !options.groups.empty();
    if (own)
        dispatch.size = parse_box("--against-groups", options.against_groups);
    else if (dispatch.size_is_groups)
        dispatch.size = parse_box("--groups", options.groups);
    else
        dispatch.size = parse_box("--invocations", options.invocations);
}

void set_texels(UserDispatch& dispatch, const SpirvOptions& options) {
    for (const std::string& text : options.texels) {
        const ConstantText texels = parse_constant("--texels", text);
        if (texels.value != "4" && texels.value != "16")
            throw UsageError(fmt::format("--texels {}: texels have 4 bytes or 16", text));
        dispatch.texel_bytes[texels.id] = texels.value == "4" ? 4 : 16;
    }
}

/// Returns the names of two shaders in tables: those of their files if these differ, else their paths.
std::array<std::string, 2> table_names(const std::filesystem::path& a, const std::filesystem::path& b) {
    if (a.filename() != b.filename()) return {a.filename().string(), b.filename().string()};
    if (a != b) return {a.string(), b.string()};
    return {a.filename().string(), a.filename().string() + " (against)"};
}

/// Reads "N=FILE", or "FILE" for the only binding that the shader writes.
std::pair<std::uint32_t, std::filesystem::path> expected_file(const std::string& text, const SpirvVersion& version) {
    const std::size_t equals = text.find('=');
    const bool has_number = equals != std::string::npos && equals > 0 && equals <= 9 &&
                            std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(equals),
                                        [](unsigned char c) { return std::isdigit(c) != 0; });
    std::vector<std::uint32_t> written;
    for (const ReflectedBinding& binding : version.interface.reflection.bindings)
        if (binding.writes) written.push_back(binding.binding);
    if (has_number) {
        const auto binding = static_cast<std::uint32_t>(std::stoul(text.substr(0, equals)));
        if (std::ranges::find(written, binding) == written.end())
            throw UsageError(fmt::format("--expect {}: {} writes no binding {}", text, version.shader.name, binding));
        return {binding, text.substr(equals + 1)};
    }
    if (written.size() != 1)
        throw UsageError(
            fmt::format("--expect {}: {} may write {} bindings; say which with N=FILE (and mark buffers 'readonly')",
                        text, version.shader.name, written.size()));
    return {written.front(), text};
}

void require_same_outputs(const SpirvVersion& version, const SpirvVersion& other) {
    for (const ReflectedBinding& binding : version.interface.reflection.bindings) {
        const ReflectedBinding* same = other.interface.binding(binding.binding);
        if (binding.writes && (!same || same->type != binding.type))
            throw UsageError(fmt::format("{} has no buffer at binding {}, which {} writes; both must write the same",
                                         other.shader.name, binding.binding, version.shader.name));
    }
}

/// Loads one shader or two, and gives them the names that tables show.
std::vector<UserShader> load_shaders(const SpirvOptions& options) {
    std::vector<UserShader> shaders{load_user_shader(options.shader, options.includes)};
    if (options.against.empty()) {
        shaders[0].name = options.shader.filename().string();
        return shaders;
    }
    shaders.push_back(load_user_shader(options.against, options.includes));
    const auto names = table_names(options.shader, options.against);
    for (std::size_t i = 0; i < 2; ++i) shaders[i].name = names[i];
    return shaders;
}

/// Returns the numbers of each shader. Throws ShaderError if a shader binds what kernels cannot bind.
std::vector<ShaderScalars> scalars_of(const std::vector<UserShader>& shaders) {
    std::vector<ShaderScalars> scalars;
    scalars.reserve(shaders.size());
    for (const UserShader& shader : shaders) {
        static_cast<void>(reflect(shader.shader()));
        scalars.push_back(reflect_scalars(shader.shader()));
    }
    return scalars;
}

/// Returns the specialization constants of the first shader (0) or the other one (1).
Constants constants_of(const SpirvOptions& options, const std::vector<ShaderScalars>& scalars, std::size_t which) {
    Constants constants;
    const ShaderScalars* other = scalars.size() > 1 ? &scalars[1 - which] : nullptr;
    set_constants(constants, "--spec", options.specs, scalars[which], other);
    if (which > 0) set_constants(constants, "--against-spec", options.against_specs, scalars[which], nullptr);
    return constants;
}

}  // namespace

SpirvJob read_spirv_job(const SpirvOptions& options) {
    if (options.groups.empty() == options.invocations.empty())
        throw UsageError("say how many invocations there are: --groups X,Y,Z (workgroups) or --invocations X,Y,Z");
    std::vector<UserShader> shaders = load_shaders(options);
    const std::vector<ShaderScalars> scalars = scalars_of(shaders);
    SpirvJob job;
    job.sources.reserve(options.binds.size());
    for (const std::string& text : options.binds) job.sources.push_back(parse_binding("--bind", text));
    job.versions.reserve(shaders.size());
    for (std::size_t i = 0; i < shaders.size(); ++i) {
        UserDispatch dispatch{
            .constants = constants_of(options, scalars, i), .texel_bytes = {}, .restores = !options.keeps};
        set_size(dispatch, options, i > 0);
        set_texels(dispatch, options);
        UserInterface interface(shaders[i], dispatch);
        const std::string push = i > 0 && scalars[i].push.empty() ? std::string() : options.push;
        Bytes pushed = push_bytes(push, scalars[i].push, interface.reflection.push_bytes);
        job.versions.push_back({std::move(shaders[i]), std::move(dispatch), std::move(interface), std::move(pushed)});
    }
    for (const std::string& text : options.expects) job.expected.push_back(expected_file(text, job.versions[0]));
    if (job.versions.size() > 1) require_same_outputs(job.versions[0], job.versions[1]);
    return job;
}

void run_spirv_statistics(const SpirvOptions& options) {
    const std::vector<UserShader> shaders = load_shaders(options);
    const std::vector<ShaderScalars> scalars = scalars_of(shaders);
    std::vector<Shader> views;
    std::vector<CompiledVariant> variants;
    views.reserve(shaders.size());
    variants.reserve(shaders.size());
    for (std::size_t i = 0; i < shaders.size(); ++i) {
        views.push_back(shaders[i].shader());
        std::vector<std::string> own = options.specs;
        if (i > 0) own.insert(own.end(), options.against_specs.begin(), options.against_specs.end());
        variants.push_back({.kernel = &views.back(),
                            .name = fmt::format("{}", fmt::join(own, ", ")),
                            .is_default = true,
                            .constants = constants_of(options, scalars, i)});
    }
    if (options.in_this_process) compile_in_this_process(variants);
    std::vector<std::string> child{"bench", "spirv", options.shader.string(), "--statistics", "--in-this-process"};
    const auto repeat = [&](const std::string& option, const std::vector<std::string>& values) {
        for (const std::string& value : values) child.insert(child.end(), {option, value});
    };
    if (!options.against.empty()) repeat("--against", {options.against.string()});
    repeat("--spec", options.specs);
    repeat("--against-spec", options.against_specs);
    for (const std::filesystem::path& include : options.includes) repeat("--include", {include.string()});
    StatisticsOptions compiling = options.compiling;
    compiling.common = options.common;
    compiling.baseline = options.baseline;
    run_statistics(compiling, child);
}

}  // namespace exemplar
