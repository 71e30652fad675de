#pragma once

#include <QDialog>
#include <QUrl>
#include <optional>

class QLineEdit;

namespace skincal {

/// Asks for a video file or the address of a stream.
class VideoDialog : public QDialog {
    Q_OBJECT
  public:
    explicit VideoDialog(QWidget* parent = nullptr);

    /// Nothing while what is typed is neither.
    [[nodiscard]] std::optional<QUrl> url() const;

  private:
    QLineEdit* where_;
};

}  // namespace skincal
