// Principal and independent components of samples, so that they can be compared with other implementations.
//   compare_components pca|ica|spatial_ica COMPONENTS IN OUT
// IN, a safetensors file: samples (rows x values); OUT: basis (values x components) and sources (rows x components).

#include <fmt/format.h>

#include <Eigen/Core>
#include <exception>
#include <string>

#include "host/core/errors.h"
#include "host/data/safetensors.h"
#include "host/learn/components/fast_ica.h"
#include "host/learn/components/pca.h"

namespace exemplar {
namespace {

using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

void add_matrix(TensorFile& file, const std::string& name, const Rows& matrix) {
    const auto rows = static_cast<std::size_t>(matrix.rows()), columns = static_cast<std::size_t>(matrix.cols());
    file.add(name, {rows, columns}, std::span<const float>(matrix.data(), rows * columns));
}

void find_components(const std::string& method, std::size_t most, const char* in, const char* out) {
    const TensorFile file = read_safetensors(in);
    const auto values = file.get<float>("samples", {TensorFile::k_any, TensorFile::k_any});
    const std::vector<std::size_t>& shape = file.tensors.at("samples").shape;
    const Eigen::MatrixXf samples =
        Eigen::Map<const Rows>(values.data(), static_cast<Eigen::Index>(shape[0]), static_cast<Eigen::Index>(shape[1]));
    TensorFile result;
    if (method == "pca") {
        const Pca pca = fit_pca(samples, 1, most);
        add_matrix(result, "basis", pca.basis);
        add_matrix(result, "sources", pca.project(samples));
    } else if (method == "ica" || method == "spatial_ica") {
        IcaOptions options;
        options.share = 1;
        options.most = most;
        const Ica ica = method == "ica" ? fit_ica(samples, options) : fit_spatial_ica(samples, options);
        add_matrix(result, "basis", ica.mixing);
        add_matrix(result, "sources", ica.sources);
    } else {
        throw UsageError(fmt::format("unknown method '{}'", method));
    }
    write_safetensors(out, result);
}

}  // namespace
}  // namespace exemplar

int main(int count, char** arguments) {
    try {
        if (count != 5) throw exemplar::UsageError("expected 4 arguments, see the head of components.cpp");
        exemplar::find_components(arguments[1], std::stoul(arguments[2]), arguments[3], arguments[4]);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "error: {}\n", error.what());
        return 1;
    }
}
