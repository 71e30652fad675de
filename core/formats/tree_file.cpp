#include "core/formats/tree_file.h"

#include <fmt/format.h>
#include <tinyxml2.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <charconv>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "core/formats/json_cursor.h"

namespace skincal {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxDepth = 32;
constexpr std::size_t kMaxValues = 100'000;

[[noreturn]] void fail(const fs::path& file, std::string place, std::string problem) {
    throw FileErrorException{{file, std::move(place), std::move(problem)}};
}

/// A number where the whole text is one, else the text itself. "657." and ".5" are numbers to YAML and OpenCV.
nlohmann::json scalar(std::string_view text) {
    std::string_view digits = text;
    if (digits.size() > 1 && digits.front() == '+' && digits[1] != '-')
        digits.remove_prefix(1);
    const char* end = digits.data() + digits.size();
    std::int64_t integer = 0;
    if (const auto result = std::from_chars(digits.data(), end, integer); result.ec == std::errc() && result.ptr == end)
        return integer;
    double number = 0;
    const auto result = std::from_chars(digits.data(), end, number);
    if (!digits.empty() && result.ec == std::errc() && result.ptr == end && std::isfinite(number))
        return number;
    return std::string(text);
}

/// Builds the tree from yaml-cpp's events: its own nodes would follow aliases, which a hostile file multiplies without
/// end.
class TreeBuilder : public YAML::EventHandler {
  public:
    explicit TreeBuilder(const fs::path& file) : file_(file) {}

    [[nodiscard]] nlohmann::json take() { return std::move(root_); }

    void OnDocumentStart(const YAML::Mark& mark) override { mark_ = mark; }
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { add(mark, nullptr); }
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
        fail(file_, place(mark), "expected plain values, found an alias");
    }
    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, const std::string& value) override {
        if (!open_.empty() && open_.back()->is_object() && !hasKey_.back()) {
            key(mark, value);
            return;
        }
        const bool quoted = tag == "!";
        add(mark, quoted ? nlohmann::json(value) : scalar(value));
    }
    void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                         YAML::EmitterStyle::value) override {
        begin(mark, nlohmann::json::array());
    }
    void OnSequenceEnd() override { end(); }
    void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
        begin(mark, nlohmann::json::object());
    }
    void OnMapEnd() override { end(); }

  private:
    static std::string place(const YAML::Mark& mark) {
        return fmt::format("line {}, column {}", mark.line + 1, mark.column + 1);
    }

    void key(const YAML::Mark& mark, const std::string& text) {
        if (open_.back()->contains(text))
            fail(file_, place(mark), fmt::format("expected each key once, '{}' is there twice", text.substr(0, 100)));
        keys_.back() = text;
        hasKey_.back() = true;
    }

    nlohmann::json& add(const YAML::Mark& mark, nlohmann::json value) {
        if (++count_ > kMaxValues)
            fail(file_, place(mark), fmt::format("expected at most {} values", kMaxValues));
        if (open_.empty())
            return root_ = std::move(value);
        nlohmann::json& parent = *open_.back();
        if (parent.is_array())
            return parent.emplace_back(std::move(value));
        if (!hasKey_.back())
            fail(file_, place(mark), "expected a key of plain text");
        hasKey_.back() = false;
        return parent[keys_.back()] = std::move(value);
    }

    void begin(const YAML::Mark& mark, nlohmann::json empty) {
        if (open_.size() >= kMaxDepth)
            fail(file_, place(mark), fmt::format("expected at most {} levels of nesting", kMaxDepth));
        // Parents stay where they are while a child is open: only the innermost list grows.
        open_.push_back(&add(mark, std::move(empty)));
        keys_.emplace_back();
        hasKey_.push_back(false);
    }

    void end() {
        open_.pop_back();
        keys_.pop_back();
        hasKey_.pop_back();
    }

    const fs::path& file_;
    nlohmann::json root_;
    YAML::Mark mark_;
    std::vector<nlohmann::json*> open_;
    std::vector<std::string> keys_;
    std::vector<bool> hasKey_;
    std::size_t count_ = 0;
};

nlohmann::json elementTree(const tinyxml2::XMLElement& element, const fs::path& file, std::size_t& count) {
    if (++count > kMaxValues)
        fail(file, fmt::format("line {}", element.GetLineNum()), fmt::format("expected at most {} values", kMaxValues));
    const char* text = element.GetText();
    if (element.FirstChildElement() == nullptr) {
        if (std::string_view(element.Name()) != "data")
            return scalar(text == nullptr ? "" : text);
        nlohmann::json list = nlohmann::json::array();
        std::istringstream words(text == nullptr ? "" : text);
        for (std::string word; words >> word;) {
            if (++count > kMaxValues)
                fail(file, fmt::format("line {}", element.GetLineNum()),
                     fmt::format("expected at most {} values", kMaxValues));
            list.push_back(scalar(word));
        }
        return list;
    }
    nlohmann::json object = nlohmann::json::object();
    for (const auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
        // A list of anything but numbers: FileStorage calls each of its elements "_". No camera needs one.
        const std::string name = child->Name();
        nlohmann::json value = elementTree(*child, file, count);
        if (name == "_")
            continue;
        if (object.contains(name))
            fail(file, fmt::format("line {}", child->GetLineNum()),
                 fmt::format("expected each element once, '{}' is there twice", name.substr(0, 100)));
        object[name] = std::move(value);
    }
    return object;
}

}  // namespace

nlohmann::json parseYaml(std::string_view text, const fs::path& file) {
    std::string own(text);
    // OpenCV's header is no directive that YAML knows, and only some parsers let it pass.
    constexpr std::string_view kOpenCvHeader = "%YAML:";
    if (own.starts_with(kOpenCvHeader))
        own.front() = '#';
    TreeBuilder builder(file);
    try {
        std::istringstream stream(own);
        YAML::Parser parser(stream);
        if (!parser.HandleNextDocument(builder))
            fail(file, "", "expected a camera calibration, the file is empty");
        nlohmann::json tree = builder.take();
        // A message printed on a terminal ends with "---", which begins a document of nothing.
        TreeBuilder rest(file);
        while (parser.HandleNextDocument(rest)) {
            if (!rest.take().is_null())
                fail(file, "", "expected one document, found several");
        }
        return tree;
    } catch (const YAML::Exception& error) {
        std::string place;
        if (!error.mark.is_null())
            place = fmt::format("line {}, column {}", error.mark.line + 1, error.mark.column + 1);
        fail(file, std::move(place), "expected YAML: " + error.msg);
    }
}

nlohmann::json parseOpenCvXml(std::string_view text, const fs::path& file) {
    tinyxml2::XMLDocument document;
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
        fail(file, fmt::format("line {}", document.ErrorLineNum()),
             fmt::format("expected XML: {}", tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID())));
    const tinyxml2::XMLElement* root = document.RootElement();
    if (root == nullptr || std::string_view(root->Name()) != "opencv_storage")
        fail(file, "", "expected XML of OpenCV, <opencv_storage>");
    std::size_t count = 0;
    return elementTree(*root, file, count);
}

}  // namespace skincal
