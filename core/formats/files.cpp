#include "core/formats/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <vector>

namespace skincal {

namespace fs = std::filesystem;

tl::expected<std::string, FileError> readFile(const fs::path& file, std::size_t maxBytes, const RunContext& context) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (status.type() == fs::file_type::not_found)
        return tl::unexpected(FileError{file, "", "expected a file, there is none"});
    if (status.type() == fs::file_type::none)
        return tl::unexpected(FileError{file, "", "expected a readable file: " + error.message()});
    if (status.type() != fs::file_type::regular)
        return tl::unexpected(FileError{file, "", "expected a regular file"});
    const auto size = fs::file_size(file, error);
    if (!error && size > maxBytes)
        return tl::unexpected(
            FileError{file, "", fmt::format("expected at most {} MB, found {}", maxBytes >> 20U, size >> 20U)});
    std::ifstream stream(file, std::ios::binary);
    std::string bytes(error ? 0 : size, '\0');
    constexpr std::size_t kBlock = std::size_t{1} << 20U;
    for (std::size_t at = 0; stream && at < bytes.size(); at += kBlock) {
        if (context.isCancelled())
            return tl::unexpected(FileError{file, "", "reading was cancelled"});
        stream.read(bytes.data() + at, static_cast<std::streamsize>(std::min(kBlock, bytes.size() - at)));
    }
    if (!stream)
        return tl::unexpected(FileError{file, "", "expected a readable file: " + std::string(std::strerror(errno))});
    return bytes;
}

tl::expected<fs::path, FileError> resolveOutput(const fs::path& file) {
    std::error_code error;
    // Following links, those of /proc included, which name no path: a device, a pipe or a directory stays what it is.
    const fs::file_status status = fs::status(file, error);
    const bool free = status.type() == fs::file_type::not_found;
    if (!free && status.type() == fs::file_type::none)
        return tl::unexpected(FileError{file, "", "can't write there: " + error.message()});
    if (file.filename().empty() || (!free && status.type() != fs::file_type::regular))
        return tl::unexpected(FileError{file, "", "expected a regular file, or none yet"});
    fs::path target = file;
    constexpr int kMaxLinks = 40;  // as the kernel has it
    for (int i = 0; i < kMaxLinks && fs::is_symlink(fs::symlink_status(target, error)); ++i)
        target = target.parent_path() / fs::read_symlink(target, error);
    const fs::path directory = target.has_parent_path() ? target.parent_path() : fs::path(".");
    if (!fs::is_directory(directory, error))
        return tl::unexpected(
            FileError{file, "", fmt::format("can't write there: there is no directory '{}'", directory.string())});
    if (::access(directory.c_str(), W_OK | X_OK) != 0)
        return tl::unexpected(FileError{file, "", fmt::format("can't write there: {}", std::strerror(errno))});
    return target;
}

bool sameFile(const fs::path& a, const fs::path& b) {
    std::error_code error;
    if (fs::equivalent(a, b, error) && !error)
        return true;
    const fs::path one = fs::weakly_canonical(a, error);
    return !error && one == fs::weakly_canonical(b, error) && !error;
}

tl::expected<void, FileError> writeFileAtomically(const fs::path& file, std::string_view bytes) {
    const auto failed = [&](const char* what) {
        return tl::unexpected(FileError{file, "", fmt::format("can't {}: {}", what, std::strerror(errno))});
    };
    const auto target = resolveOutput(file);
    if (!target)
        return tl::unexpected(target.error());
    std::string pattern = target->string() + ".XXXXXX";
    const int descriptor = ::mkstemp(pattern.data());
    if (descriptor < 0)
        return failed("write there");
    std::size_t written = 0;
    while (written < bytes.size()) {
        const ssize_t n = ::write(descriptor, bytes.data() + written, bytes.size() - written);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            break;
        written += static_cast<std::size_t>(n);
    }
    // mkstemp makes private files; what people export is as readable as any other file of theirs.
    const mode_t mask = ::umask(0);
    ::umask(mask);
    const bool ok = written == bytes.size() && ::fchmod(descriptor, 0666 & ~mask) == 0 && ::fsync(descriptor) == 0;
    const int reason = errno;
    ::close(descriptor);
    if (!ok || ::rename(pattern.c_str(), target->c_str()) != 0) {
        errno = ok ? errno : reason;
        auto result = failed("write the file");
        ::unlink(pattern.c_str());
        return result;
    }
    return {};
}

std::string sha256(std::string_view bytes) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int length = 0;
    if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1)
        throw std::runtime_error("SHA-256 is not available");
    std::string text;
    for (unsigned int i = 0; i < length; ++i)
        text += fmt::format("{:02x}", digest.at(i));
    return text;
}

tl::expected<fs::path, std::string> resolveInside(const fs::path& directory, const std::string& relative) {
    const tl::unexpected<std::string> outside("expected a path inside the recording, found '" + relative + "'");
    const fs::path path(relative);
    if (relative.empty() || relative.find('\0') != std::string::npos || path.is_absolute())
        return outside;
    std::error_code error;
    const fs::path root = fs::weakly_canonical(directory, error);
    const fs::path full = error ? fs::path() : fs::weakly_canonical(root / path, error);
    if (error)
        return outside;
    const fs::path back = full.lexically_relative(root);
    if (back.empty() || *back.begin() == ".." || back == ".") {
        const fs::path written = path.lexically_normal();
        if (written != "." && *written.begin() != "..")
            return tl::unexpected<std::string>("expected a path inside the recording, a symbolic link in '" + relative +
                                               "' leads out of it");
        return outside;
    }
    return full;
}

}  // namespace skincal
