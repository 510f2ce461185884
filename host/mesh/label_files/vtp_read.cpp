// Labels of the cells of VTK's XML PolyData (.vtp), as ParaView, vedo and Mesh_Labeler write them.
#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <memory>

#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_text.h"
#include "host/mesh/label_files/label_formats.h"
#include "host/mesh/label_files/vtp_array.h"

namespace exemplar::label_files {
namespace {

/// The parts of a file that can be labels: the arrays of its cells, and the label names that Exemplar writes.
struct VtpContent {
    VtkEncoding encoding;
    std::vector<VtkArray> arrays;
    std::string label_names;  ///< codes of characters, each name ends with 0
    std::int64_t polygons = -1, other_cells = 0;
    int pieces = 0;
};

/// Follows the elements of a file down to the arrays of its cells.
class VtpParser {
  public:
    VtpParser(VtpContent& content, const std::string& name)
        : content_(content), name_(name), parser_(XML_ParserCreate(nullptr), XML_ParserFree) {
        XML_SetUserData(parser_.get(), this);
        XML_SetElementHandler(parser_.get(), on_start, on_end);
        XML_SetCharacterDataHandler(parser_.get(), on_text);
    }

    /// Parses the elements before the appended data; `is_whole`: the text ends with the last element.
    void parse(std::string_view text, bool is_whole) {
        constexpr std::size_t k_most = std::size_t{1} << 30;
        if (text.size() > k_most) fail(name_, "the file is larger than 1 GiB; save its data appended");
        const auto status = XML_Parse(parser_.get(), text.data(), static_cast<int>(text.size()), is_whole ? 1 : 0);
        if (failure_) std::rethrow_exception(failure_);
        if (status != XML_STATUS_OK)
            fail(fmt::format("{}:{}", name_, XML_GetCurrentLineNumber(parser_.get())),
                 fmt::format("the XML is malformed ({})", XML_ErrorString(XML_GetErrorCode(parser_.get()))));
    }

  private:
    using Attributes = const XML_Char**;

    static std::string text_of(Attributes attributes, std::string_view key) {
        for (; *attributes; attributes += 2)
            if (attributes[0] == key) return attributes[1];
        return {};
    }
    std::int64_t number_of(Attributes attributes, std::string_view key) const {
        const std::string text = text_of(attributes, key);
        if (text.empty()) return 0;
        const auto value = mesh_io::parse_integer(text);
        if (!value || *value < 0) fail_here(fmt::format("{} should be a count, not {}", key, mesh_io::quote(text)));
        return *value;
    }
    [[noreturn]] void fail_here(const std::string& message) const {
        fail(fmt::format("{}:{}", name_, XML_GetCurrentLineNumber(parser_.get())), message);
    }

    void start(std::string_view element, Attributes attributes) {
        if (element == "VTKFile") read_file_attributes(attributes);
        if (element == "Piece") {
            ++content_.pieces;
            content_.polygons = number_of(attributes, "NumberOfPolys");
            for (const char* key : {"NumberOfVerts", "NumberOfLines", "NumberOfStrips"})
                content_.other_cells += number_of(attributes, key);
        }
        if (element == "CellData") in_cells_ = true;
        if (element != "DataArray" && element != "Array") return;
        if (text_of(attributes, "Name") == "LabelNames" && !in_cells_) target_ = &content_.label_names;
        if (in_cells_) start_array(attributes);
    }
    void read_file_attributes(Attributes attributes) {
        if (text_of(attributes, "type") != "PolyData")
            fail_here(fmt::format("holds {}, not PolyData; save the surface as .vtp",
                                  mesh_io::quote(text_of(attributes, "type"))));
        if (text_of(attributes, "byte_order") == "BigEndian") fail_here("is big-endian; save it little-endian");
        if (text_of(attributes, "header_type") == "UInt64") content_.encoding.header_bytes = 8;
        const std::string compressor = text_of(attributes, "compressor");
        content_.encoding.is_compressed = !compressor.empty();
        if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
            fail_here(fmt::format("is compressed by {}; save it with zlib or without", mesh_io::quote(compressor)));
    }
    void start_array(Attributes attributes) {
        const std::string components = text_of(attributes, "NumberOfComponents");
        if (!components.empty() && components != "1") return;
        VtkArray array{text_of(attributes, "Name"), text_of(attributes, "type"), text_of(attributes, "format"), 0, {}};
        array.offset = static_cast<std::uint64_t>(number_of(attributes, "offset"));
        content_.arrays.push_back(std::move(array));
        target_ = &content_.arrays.back().text;
    }
    void end(std::string_view element) {
        if (element == "CellData") in_cells_ = false;
        if (element == "DataArray" || element == "Array") target_ = nullptr;
    }

    /// Runs `work`; an exception ends parsing, since it must not pass through Expat.
    template <typename Work>
    static void guarded(void* self, const Work& work) {
        VtpParser& parser = *static_cast<VtpParser*>(self);
        if (parser.failure_) return;
        try {
            work(parser);
        } catch (...) {
            parser.failure_ = std::current_exception();
            XML_StopParser(parser.parser_.get(), XML_FALSE);
        }
    }
    static void on_start(void* self, const XML_Char* element, Attributes attributes) {
        guarded(self, [&](VtpParser& parser) { parser.start(element, attributes); });
    }
    static void on_end(void* self, const XML_Char* element) {
        guarded(self, [&](VtpParser& parser) { parser.end(element); });
    }
    static void on_text(void* self, const XML_Char* text, int count) {
        guarded(self, [&](VtpParser& parser) {
            if (parser.target_) parser.target_->append(text, static_cast<std::size_t>(count));
        });
    }

    VtpContent& content_;
    const std::string& name_;
    std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
    std::exception_ptr failure_;
    bool in_cells_ = false;
    std::string* target_ = nullptr;  ///< where the text of the open array goes
};

/// Appended data may be any bytes, which are no XML: the text before them is parsed by itself.
VtpContent parse_vtp(std::string_view content, const std::string& name) {
    VtpContent vtp;
    vtp.arrays.reserve(64);
    const std::size_t appended = content.find("<AppendedData");
    VtpParser parser(vtp, name);
    parser.parse(content.substr(0, appended), appended == std::string_view::npos);
    if (appended == std::string_view::npos) return vtp;
    const std::size_t end = content.find('>', appended), begin = content.find('_', std::min(end, content.size()));
    if (begin == std::string_view::npos) fail(name, "its appended data do not begin with _");
    vtp.encoding.appended = content.substr(begin + 1);
    vtp.encoding.appended_is_raw = content.substr(appended, end - appended).find("base64") == std::string_view::npos;
    return vtp;
}

/// Returns the array that is named as labels usually are, or the only one.
const VtkArray& array_of_labels(const VtpContent& vtp, const std::string& name) {
    for (const char* usual : {"label", "labels", "materialids", "groupids"})
        for (const VtkArray& array : vtp.arrays)
            if (lower_case(array.name) == usual) return array;
    if (vtp.arrays.size() == 1) return vtp.arrays.front();
    fail(name, fmt::format("has {} arrays of its cells, none of them named Label; rename the one with labels",
                           vtp.arrays.size()));
}

/// Splits the codes of characters into names; an empty list if they are none that labels can have.
std::vector<std::string> decoded_names(std::string_view codes) {
    std::vector<std::string> names(1);
    for (std::string_view word = mesh_io::take_word(codes); !word.empty(); word = mesh_io::take_word(codes)) {
        const auto code = mesh_io::parse_integer(word);
        if (!code || *code < -128 || *code > 255) return {};
        if (*code == 0)
            names.emplace_back();
        else
            names.back() += static_cast<char>(*code);
    }
    names.pop_back();
    if (!std::ranges::all_of(names, mesh_io::is_label_name)) return {};
    return names;
}

}  // namespace

FaceLabels read_vtp_labels(std::string_view content, const TriangleMesh& mesh, const std::string& name) {
    const VtpContent vtp = parse_vtp(content, name);
    if (vtp.pieces != 1) fail(name, fmt::format("has {} pieces; save one surface", vtp.pieces));
    if (vtp.other_cells > 0) fail(name, "has cells other than polygons; save only the surface");
    const std::size_t faces = mesh_io::source_faces(mesh);
    if (vtp.polygons != static_cast<std::int64_t>(faces))
        fail(name, fmt::format("has {} polygons, but the mesh has {} faces", vtp.polygons, faces));
    const VtkArray& array = array_of_labels(vtp, name);
    std::vector<std::int64_t> numbers = vtk_integers(array, vtp.encoding, faces, name);
    return labels_of_numbers(numbers, decoded_names(vtp.label_names), mesh, name);
}

}  // namespace exemplar::label_files
