#include "core/formats/stl_file.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "core/formats/files.h"
#include "core/mesh/in_steps.h"

namespace skincal {
namespace {

static_assert(std::endian::native == std::endian::little, "STL is little-endian, and so is what we copy");

constexpr std::size_t kMaxBytes = std::size_t{100} << 20U;
constexpr std::size_t kHeader = 84;  // with the count
constexpr std::size_t kFacet = 50;
constexpr double kFarthest = 1e9;

using Result = tl::expected<TriangleMesh, FileError>;

tl::unexpected<FileError> cancelled(const std::filesystem::path& file) {
    return tl::unexpected(FileError{file, "", "reading was cancelled"});
}

bool isPlace(const Vector3d& corner) {
    return corner.allFinite() && corner.cwiseAbs().maxCoeff() <= kFarthest;
}

std::uint32_t countOf(std::string_view bytes) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + kHeader - sizeof count, sizeof count);
    return count;
}

Result parseBinary(std::string_view bytes, const std::filesystem::path& file, const RunContext& context) {
    TriangleMesh mesh;
    const std::uint32_t count = countOf(bytes);
    mesh.vertices.reserve(std::size_t{3} * count);
    mesh.triangles.reserve(count);
    for (std::uint32_t t = 0; t < count; ++t) {
        if (t % kAskEvery == 0 && context.isCancelled())
            return cancelled(file);
        std::array<float, 12> numbers{};
        std::memcpy(numbers.data(), bytes.data() + kHeader + kFacet * t, sizeof numbers);
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const float* at = numbers.data() + 3 + 3 * corner;
            mesh.vertices.emplace_back(at[0], at[1], at[2]);
            if (!isPlace(mesh.vertices.back()))
                return tl::unexpected(FileError{file, fmt::format("facet {}", t + 1),
                                                "expected three corners with coordinates up to 1e9"});
        }
        mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    return mesh;
}

/// Words of a text, and in which line they are.
class Words {
  public:
    explicit Words(std::string_view text) : text_(text) {}
    /// Empty at the end.
    std::string_view next() {
        while (at_ < text_.size() && isSpace(text_[at_]))
            line_ += text_[at_++] == '\n' ? 1 : 0;
        const std::size_t begin = at_;
        while (at_ < text_.size() && !isSpace(text_[at_]))
            ++at_;
        return text_.substr(begin, at_ - begin);
    }
    void skipLine() {
        while (at_ < text_.size() && text_[at_] != '\n')
            ++at_;
    }
    [[nodiscard]] std::string place() const { return fmt::format("line {}", line_); }

  private:
    static bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f'; }
    std::string_view text_;
    std::size_t at_ = 0;
    std::size_t line_ = 1;
};

bool isWord(std::string_view word, std::string_view expected) {
    const auto same = [](char a, char b) { return (a | 0x20) == b; };
    return std::equal(word.begin(), word.end(), expected.begin(), expected.end(), same);
}

std::optional<double> numberOf(std::string_view word) {
    if (word.starts_with('+'))
        word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size() ? std::optional(value) : std::nullopt;
}

Result parseText(std::string_view text, const std::filesystem::path& file, const RunContext& context) {
    TriangleMesh mesh;
    Words words(text);
    const auto failed = [&](const std::string& expected, std::string_view found) {
        return tl::unexpected(FileError{
            file, words.place(),
            found.empty() ? fmt::format("expected {}, the file ends", expected)
                          : fmt::format("expected {}, found '{}'", expected, std::string(found.substr(0, 40)))});
    };
    std::size_t turns = 0;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
        if (turns++ % kAskEvery == 0 && context.isCancelled())
            return cancelled(file);
        if (isWord(word, "solid") || isWord(word, "endsolid")) {
            words.skipLine();  // any name, with spaces
            continue;
        }
        if (!isWord(word, "facet"))
            return failed("'facet' or 'endsolid'", word);
        words.skipLine();  // the normal, which follows from the corners
        for (const char* expected : {"outer", "loop"}) {
            if (word = words.next(); !isWord(word, expected))
                return failed("'outer loop'", word);
        }
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (int corner = 0; corner < 3; ++corner) {
            if (word = words.next(); !isWord(word, "vertex"))
                return failed("three times 'vertex'", word);
            Vector3d place;
            for (double& coordinate : place) {
                word = words.next();
                const auto number = numberOf(word);
                if (!number || !std::isfinite(*number) || std::abs(*number) > kFarthest)
                    return failed("a coordinate up to 1e9", word);
                coordinate = *number;
            }
            mesh.vertices.push_back(place);
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
        for (const char* expected : {"endloop", "endfacet"}) {
            if (word = words.next(); !isWord(word, expected))
                return failed(fmt::format("'{}'", expected), word);
        }
    }
    return mesh;
}

}  // namespace

Result parseStl(const std::string& bytes, const std::filesystem::path& file, const RunContext& context) {
    const bool hasCount = bytes.size() >= kHeader;
    const bool isBinary = hasCount && bytes.size() == kHeader + kFacet * std::size_t{countOf(bytes)};
    const bool isText = !isBinary && isWord(std::string_view(bytes).substr(0, 5), "solid");
    if (!isBinary && !isText) {
        return tl::unexpected(FileError{
            file, "",
            bytes.empty() ? "expected an STL mesh, the file is empty"
            : hasCount    ? fmt::format("expected an STL mesh: a text that begins with 'solid', or, of the {} facets "
                                           "that the file says it has, {} bytes; found {}",
                                        countOf(bytes), kHeader + kFacet * std::size_t{countOf(bytes)}, bytes.size())
                          : fmt::format("expected an STL mesh: a text that begins with 'solid', or at least {} bytes; "
                                           "found {}",
                                        kHeader, bytes.size())});
    }
    Result mesh = isBinary ? parseBinary(bytes, file, context) : parseText(bytes, file, context);
    if (!mesh)
        return mesh;
    const std::size_t facets = mesh->triangles.size();
    mesh = turnedOutwards(welded(*mesh, context), context);
    if (context.isCancelled())
        return cancelled(file);
    if (mesh->triangles.empty())
        return tl::unexpected(
            FileError{file, "", fmt::format("expected a surface, found {} facets, none of which has an area", facets)});
    return mesh;
}

Result readStl(const std::filesystem::path& file, const RunContext& context) {
    const auto bytes = readFile(file, kMaxBytes, context);
    if (!bytes)
        return tl::unexpected(bytes.error());
    return parseStl(*bytes, file, context);
}

std::string stlBytes(const TriangleMesh& mesh) {
    // Not "solid": readers take that for text.
    std::string bytes = "binary STL";
    bytes.resize(kHeader - sizeof(std::uint32_t), ' ');
    const auto add = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
    add(static_cast<std::uint32_t>(mesh.triangles.size()));
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Eigen::Vector3f normal = mesh.crossOf(t).normalized().cast<float>();
        for (int i = 0; i < 3; ++i)
            add(normal[i]);
        for (const std::uint32_t corner : mesh.triangles[t]) {
            const Eigen::Vector3f place = mesh.vertices[corner].cast<float>();
            for (int i = 0; i < 3; ++i)
                add(place[i]);
        }
        add(std::uint16_t{0});
    }
    return bytes;
}

}  // namespace skincal
