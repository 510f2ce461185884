// Runs FastICA on a file of numbers, so that its result can be compared with other implementations.
//   unmix ROWS COLUMNS COMPONENTS symmetric|deflation log_cosh|gauss|kurtosis IN OUT
// IN: float32, little-endian, ROWS x COLUMNS, row after row; OUT: the unmixing matrix, COMPONENTS x COLUMNS, likewise.

#include <fmt/format.h>

#include <exception>
#include <fstream>
#include <map>
#include <string>

#include "host/core/errors.h"
#include "host/learn/components/fast_ica.h"

namespace exemplar {
namespace {

using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::MatrixXf read_samples(const std::string& path, Eigen::Index rows, Eigen::Index columns) {
    RowMajor samples(rows, columns);
    std::ifstream stream(path, std::ios::binary);
    stream.read(reinterpret_cast<char*>(samples.data()),
                static_cast<std::streamsize>(static_cast<std::size_t>(samples.size()) * sizeof(float)));
    if (!stream)
        throw DataError(fmt::format("{}: cannot be read, or has less than {} x {} numbers", path, rows, columns));
    return samples;
}

void write_matrix(const std::string& path, const RowMajor& matrix) {
    std::ofstream stream(path, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(matrix.data()),
                 static_cast<std::streamsize>(static_cast<std::size_t>(matrix.size()) * sizeof(float)));
    if (!stream.flush()) throw DataError(fmt::format("{}: cannot be written", path));
}

void unmix(char** arguments) {
    static const std::map<std::string, IcaScheme> k_schemes{{"symmetric", IcaScheme::symmetric},
                                                            {"deflation", IcaScheme::deflation}};
    static const std::map<std::string, IcaContrast> k_contrasts{
        {"log_cosh", IcaContrast::log_cosh}, {"gauss", IcaContrast::gauss}, {"kurtosis", IcaContrast::kurtosis}};
    IcaOptions options;
    options.share = 1;
    options.most = std::stoul(arguments[3]);
    options.scheme = k_schemes.at(arguments[4]);
    options.contrast = k_contrasts.at(arguments[5]);
    options.tolerance = 1e-6;
    const Ica ica = fit_ica(read_samples(arguments[6], std::stol(arguments[1]), std::stol(arguments[2])), options);
    if (!ica.converged) throw DataError(fmt::format("not converged in {} iterations", ica.iterations));
    write_matrix(arguments[7], ica.unmixing);
}

}  // namespace
}  // namespace exemplar

int main(int count, char** arguments) {
    try {
        if (count != 8) throw exemplar::UsageError("expected 7 arguments, see the head of unmix.cpp");
        exemplar::unmix(arguments);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "error: {}\n", error.what());
        return 1;
    }
}
