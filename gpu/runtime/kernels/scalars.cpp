#include "gpu/runtime/kernels/scalars.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gpu/runtime/kernels/spirv_module.h"

namespace exemplar {
namespace {

constexpr std::size_t k_max_scalars = 4096;  // of a block's head, or of an element

ScalarType scalar_type(spvc_basetype type) {
    switch (type) {
        case SPVC_BASETYPE_FP32:
            return ScalarType::float32;
        case SPVC_BASETYPE_INT32:
            return ScalarType::int32;
        case SPVC_BASETYPE_UINT32:
            return ScalarType::uint32;
        case SPVC_BASETYPE_BOOLEAN:
            return ScalarType::boolean;
        case SPVC_BASETYPE_FP16:
            return ScalarType::float16;
        case SPVC_BASETYPE_FP64:
            return ScalarType::float64;
        default:
            return ScalarType::other;
    }
}

// A number of equal parts in memory, such as an array or the columns of a matrix.
struct ScalarParts {
    std::size_t count, stride;
};

// Lists the numbers of a type in the order of memory.
class ScalarLister {
  public:
    ScalarLister(const SpirvModule& module, std::vector<ReflectedScalar>& scalars)
        : module_(module), scalars_(scalars) {}

    bool complete() const { return complete_; }

    void add_structure(spvc_type type, const std::string& prefix, std::size_t offset, unsigned first, unsigned end) {
        for (unsigned member = first; member < end; ++member) {
            unsigned at = 0;
            module_.require(spvc_compiler_type_struct_member_offset(module_.compiler(), type, member, &at));
            const char* name =
                spvc_compiler_get_member_name(module_.compiler(), spvc_type_get_base_type_id(type), member);
            const std::string own = *name ? name : fmt::format("member {}", member);
            add_member(type, member, prefix.empty() ? own : fmt::format("{}.{}", prefix, own), offset + at);
        }
    }

    // Adds what one element of an array consists of.
    void add_element(spvc_type block, unsigned member) {
        add_parts(block, member, element_parts(block, member, true), 0, {}, 0);
    }

  private:
    void add_member(spvc_type block, unsigned member, const std::string& name, std::size_t offset) {
        add_parts(block, member, element_parts(block, member, false), 0, name, offset);
    }

    // Returns the dimensions of a member from the outermost to the vectors of a matrix and the numbers of a vector.
    std::vector<ScalarParts> element_parts(spvc_type block, unsigned member, bool of_element) {
        const spvc_type type = member_type(block, member);
        std::vector<ScalarParts> parts;
        const unsigned dimensions = spvc_type_get_num_array_dimensions(type);
        unsigned stride = 0;
        if (dimensions > 0)
            module_.require(spvc_compiler_type_struct_member_array_stride(module_.compiler(), block, member, &stride));
        for (unsigned d = dimensions; d-- > 0;) {
            const std::size_t count = spvc_type_get_array_dimension(type, d);
            if (!spvc_type_array_dimension_is_literal(type, d)) complete_ = false;
            const bool outermost = d + 1 == dimensions;
            if (!outermost) stride /= static_cast<unsigned>(std::max<std::size_t>(count, 1));
            if (!(outermost && of_element)) parts.push_back({count, stride});
        }
        if (spvc_type_get_basetype(type) == SPVC_BASETYPE_STRUCT) return parts;
        std::size_t columns = spvc_type_get_columns(type), rows = spvc_type_get_vector_size(type);
        if (columns > 1) {
            module_.require(spvc_compiler_type_struct_member_matrix_stride(module_.compiler(), block, member, &stride));
            if (spvc_compiler_has_member_decoration(module_.compiler(), spvc_type_get_base_type_id(block), member,
                                                    SpvDecorationRowMajor))
                std::swap(columns, rows);
            parts.push_back({columns, stride});
        }
        const ScalarType scalar = scalar_type(spvc_type_get_basetype(type));
        if (rows > 1) parts.push_back({rows, bytes_of(scalar)});
        return parts;
    }

    void add_parts(spvc_type block, unsigned member, const std::vector<ScalarParts>& parts, std::size_t depth,
                   const std::string& name, std::size_t offset) {
        if (depth < parts.size()) {
            for (std::size_t i = 0; i < parts[depth].count && complete_; ++i)
                add_parts(block, member, parts, depth + 1, fmt::format("{}[{}]", name, i),
                          offset + i * parts[depth].stride);
            return;
        }
        const spvc_type type = member_type(block, member);
        if (spvc_type_get_basetype(type) == SPVC_BASETYPE_STRUCT) {
            const spvc_type structure = module_.type(spvc_type_get_base_type_id(type));
            add_structure(structure, name, offset, 0, spvc_type_get_num_member_types(structure));
            return;
        }
        const ScalarType scalar = scalar_type(spvc_type_get_basetype(type));
        if (scalar == ScalarType::other || scalars_.size() >= k_max_scalars) complete_ = false;
        if (scalars_.size() < k_max_scalars) scalars_.push_back({name, offset, scalar});
    }

    spvc_type member_type(spvc_type block, unsigned member) const {
        return module_.type(spvc_type_get_member_type(block, member));
    }

    const SpirvModule& module_;
    std::vector<ReflectedScalar>& scalars_;
    bool complete_ = true;
};

BlockScalars block_scalars(const SpirvModule& module, const spvc_reflected_resource& resource) {
    const spvc_type block = module.type(resource.base_type_id);
    const unsigned members = spvc_type_get_num_member_types(block);
    BlockScalars result;
    result.binding = spvc_compiler_get_decoration(module.compiler(), resource.id, SpvDecorationBinding);
    if (members == 0) return result;
    const spvc_type last = module.type(spvc_type_get_member_type(block, members - 1));
    const unsigned dimensions = spvc_type_get_num_array_dimensions(last);
    ScalarLister head(module, result.head);
    head.add_structure(block, {}, 0, 0, dimensions > 0 ? members - 1 : members);
    result.complete = head.complete();
    if (dimensions == 0) {
        module.require(spvc_compiler_get_declared_struct_size(module.compiler(), block, &result.head_bytes));
        return result;
    }
    unsigned offset = 0, stride = 0;
    module.require(spvc_compiler_type_struct_member_offset(module.compiler(), block, members - 1, &offset));
    module.require(spvc_compiler_type_struct_member_array_stride(module.compiler(), block, members - 1, &stride));
    result.head_bytes = offset;
    result.stride = stride;
    if (spvc_type_array_dimension_is_literal(last, dimensions - 1))
        result.fixed_count = spvc_type_get_array_dimension(last, dimensions - 1);
    ScalarLister element(module, result.element);
    element.add_element(block, members - 1);
    result.complete = result.complete && element.complete();
    return result;
}

void add_constants(const SpirvModule& module, std::vector<ReflectedConstant>& result) {
    const spvc_specialization_constant* constants = nullptr;
    std::size_t count = 0;
    module.require(spvc_compiler_get_specialization_constants(module.compiler(), &constants, &count));
    for (const spvc_specialization_constant& constant : std::span(constants, count)) {
        const spvc_constant handle = spvc_compiler_get_constant_handle(module.compiler(), constant.id);
        const spvc_type type = module.type(spvc_constant_get_type(handle));
        result.push_back({constant.constant_id, spvc_compiler_get_name(module.compiler(), constant.id),
                          scalar_type(spvc_type_get_basetype(type))});
    }
    std::ranges::sort(result, {}, &ReflectedConstant::id);
}

}  // namespace

std::string_view to_string(ScalarType type) {
    switch (type) {
        case ScalarType::float32:
            return "float";
        case ScalarType::int32:
            return "int";
        case ScalarType::uint32:
            return "uint";
        case ScalarType::boolean:
            return "bool";
        case ScalarType::float16:
            return "half";
        case ScalarType::float64:
            return "double";
        case ScalarType::other:
            break;
    }
    return "another type";
}

std::size_t bytes_of(ScalarType type) {
    switch (type) {
        case ScalarType::float16:
            return 2;
        case ScalarType::float64:
            return 8;
        case ScalarType::other:
            return 0;
        default:
            return 4;
    }
}

ShaderScalars reflect_scalars(const Shader& shader) {
    const SpirvModule module(shader);
    ShaderScalars result;
    for (const spvc_reflected_resource& resource : module.resources(SPVC_RESOURCE_TYPE_PUSH_CONSTANT)) {
        const spvc_type block = module.type(resource.base_type_id);
        ScalarLister(module, result.push).add_structure(block, {}, 0, 0, spvc_type_get_num_member_types(block));
    }
    for (const spvc_reflected_resource& resource : module.resources(SPVC_RESOURCE_TYPE_STORAGE_BUFFER))
        result.blocks.push_back(block_scalars(module, resource));
    std::ranges::sort(result.blocks, {}, &BlockScalars::binding);
    add_constants(module, result.constants);
    return result;
}

}  // namespace exemplar
