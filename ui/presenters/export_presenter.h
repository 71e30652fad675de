#pragma once

#include <QObject>
#include <QThreadPool>
#include <atomic>
#include <filesystem>

#include "core/session/session_storage.h"
#include "ui/presenters/workbench.h"
#include "ui/print/report.h"

namespace skincal {

struct ExportFormat {
    QString name;
    QString suffix;       ///< of the file, with its dot
    QString description;  ///< what it holds, its frames and units
    std::function<std::string(const BodyModel&, const ReportFacts&)> bytes;
    bool isReport = false;  ///< for people: bears the time at which it was written, and the data with what decided
    bool isTraced = false;  ///< bears the digests of the data
};

/// Writes the newest body for other programs, in the background: with 1,000 modules a file takes longer than a frame.
class ExportPresenter : public QObject {
    Q_OBJECT
  public:
    explicit ExportPresenter(Workbench& workbench, QObject* parent = nullptr);
    /// Waits for what is being written.
    ~ExportPresenter() override;

    [[nodiscard]] const std::vector<ExportFormat>& formats() const { return formats_; }
    /// Null before there is a placed module.
    [[nodiscard]] const BodyModel* body() const;
    /// Asks for the beginning of the file, at most so many lines: previewed() brings it, unless another was asked for
    /// meanwhile. Empty where there is nothing to export.
    void preview(std::size_t format, int lines);
    /// Whole or not at all; written() or failed() tells.
    void write(std::size_t format, const std::filesystem::path& file);
    [[nodiscard]] bool isWriting() const { return writing_ > 0; }

  signals:
    void changed();
    void previewed(const QString& text);
    /// @param of  what was written, which may not be the newest any more.
    void written(const QString& file, const std::shared_ptr<const skincal::Solution>& of);
    void failed(const QString& why);

  private:
    /// Null as body() is.
    [[nodiscard]] std::shared_ptr<const Solution> solution() const;
    [[nodiscard]] ReportFacts factsOf(const Solution& solution) const;
    /// Makes the file's bytes, on the pool's thread. Digests of pictures take long: a preview does without those that
    /// are not known yet.
    [[nodiscard]] std::function<std::string()> job(std::size_t format, std::shared_ptr<const Solution> solution,
                                                   bool isPreview);

    Workbench& workbench_;
    std::vector<ExportFormat> formats_;
    std::atomic<std::uint64_t> asked_ = 0;  ///< the newest preview
    int writing_ = 0;
    PictureDigests digests_;  ///< touched by the pool's one thread only
    std::atomic<bool> isClosing_ = false;
    QThreadPool pool_;
};

}  // namespace skincal
