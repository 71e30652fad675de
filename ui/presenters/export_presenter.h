#pragma once

#include <QObject>
#include <filesystem>

#include "ui/presenters/workbench.h"
#include "ui/print/report.h"

namespace skincal {

struct ExportFormat {
    QString name;
    QString suffix;       ///< of the file, with its dot
    QString description;  ///< what it holds, its frames and units
    std::function<std::string(const Solution&)> bytes;
    bool isReport = false;  ///< for people: bears the time at which it was written
};

/// Writes the newest body for other programs.
class ExportPresenter : public QObject {
    Q_OBJECT
  public:
    explicit ExportPresenter(Workbench& workbench, QObject* parent = nullptr);

    [[nodiscard]] const std::vector<ExportFormat>& formats() const { return formats_; }
    /// Null before there is a placed module.
    [[nodiscard]] const BodyModel* body() const;
    /// The beginning of the file, at most so many lines.
    [[nodiscard]] QString preview(std::size_t format, int lines) const;
    /// Whole or not at all. @return a complaint; empty where it was written.
    [[nodiscard]] QString write(std::size_t format, const std::filesystem::path& file);

  signals:
    void changed();
    void written(const QString& file);

  private:
    /// Null as body() is.
    [[nodiscard]] const Solution* solution() const;
    [[nodiscard]] ReportFacts factsOf(const Solution& solution) const;

    Workbench& workbench_;
    std::vector<ExportFormat> formats_;
};

}  // namespace skincal
