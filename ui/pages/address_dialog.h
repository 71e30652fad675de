#pragma once

#include <QDialog>
#include <optional>

#include "core/device/line_address.h"

class QLabel;
class QLineEdit;

namespace skincal {

/// Asks where a skin is plugged in that is not in the list: another speed, a gateway, a bridge, a pseudo-terminal.
class AddressDialog : public QDialog {
    Q_OBJECT
  public:
    explicit AddressDialog(QWidget* parent = nullptr);

    /// Nothing where what was typed is no address.
    [[nodiscard]] std::optional<LineAddress> address() const;

  private:
    QLineEdit* where_;
    QLabel* hint_;
};

}  // namespace skincal
