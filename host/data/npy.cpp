#include "host/data/npy.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "host/core/files.h"

namespace exemplar {
namespace {

static_assert(std::endian::native == std::endian::little, "write_npy writes the machine's own floats");

/// Returns magic, version, length and text of the header, padded so that the data begin at a multiple of 64 bytes.
std::string npy_header(std::size_t rows, std::size_t cols) {
    constexpr std::size_t k_before_text = 10, k_alignment = 64;
    std::string text = fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}), }}", rows, cols);
    text.append(k_alignment - (k_before_text + text.size() + 1) % k_alignment, ' ');
    text.push_back('\n');
    std::string header("\x93NUMPY\x01\x00", 8);
    header.push_back(static_cast<char>(text.size() & 0xffU));
    header.push_back(static_cast<char>(text.size() >> 8U));
    return header + text;
}

}  // namespace

void write_npy(const std::filesystem::path& path, const FeatureMatrix& matrix, std::span<const std::uint32_t> row_of) {
    const std::size_t items = row_of.empty() ? matrix.rows : row_of.size();
    write_file_atomically(path, [&](std::ostream& stream) {
        const std::string header = npy_header(items, matrix.cols());
        stream.write(header.data(), static_cast<std::streamsize>(header.size()));
        std::vector<float> row(matrix.cols());
        for (std::size_t i = 0; i < items; ++i) {
            const std::size_t source = row_of.empty() ? i : row_of[i];
            for (std::size_t k = 0; k < row.size(); ++k) row[k] = matrix.column(k)[source];
            stream.write(reinterpret_cast<const char*>(row.data()),
                         static_cast<std::streamsize>(row.size() * sizeof(float)));
        }
    });
}

}  // namespace exemplar
