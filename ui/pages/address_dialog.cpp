#include "ui/pages/address_dialog.h"

#include <QDialogButtonBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QVBoxLayout>

namespace skincal {

AddressDialog::AddressDialog(QWidget* parent) : QDialog(parent), where_(new QLineEdit), hint_(new QLabel) {
    setWindowTitle(tr("Skin at another address"));
    setMinimumWidth(560);
    auto* column = new QVBoxLayout(this);
    auto* explanation =
        new QLabel(tr("<p>Where the skin is plugged in:</p><table cellpadding=3>"
                      "<tr><td><code>/dev/ttyUSB0@921600</code></td><td>a serial port, and its speed where it is not 3 "
                      "Mbaud</td></tr>"
                      "<tr><td><code>tcp://gateway.local:5760</code></td><td>a gateway in the network</td></tr>"
                      "<tr><td><code>exec:python3 bridge.py</code></td><td>a program that speaks the skin "
                      "protocol</td></tr></table>"));
    explanation->setWordWrap(true);
    column->addWidget(explanation);
    where_->setObjectName(QStringLiteral("address"));
    where_->setAccessibleName(tr("Address"));
    where_->setToolTip(tr("Port, host or program of the skin"));
    column->addWidget(where_);
    hint_->setWordWrap(true);
    column->addWidget(hint_);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
    QPushButton* use = buttons->button(QDialogButtonBox::Ok);
    use->setText(tr("Use it"));
    use->setToolTip(tr("Put it among the skins to choose from, and choose it"));
    use->setEnabled(false);
    buttons->button(QDialogButtonBox::Cancel)->setToolTip(tr("Stay with the skin that is chosen"));
    column->addWidget(buttons);
    connect(where_, &QLineEdit::textChanged, this, [this, use](const QString& text) {
        const auto parsed = parseLineAddress(text);
        use->setEnabled(parsed.has_value());
        hint_->setText(parsed || text.trimmed().isEmpty() ? QString() : parsed.error());
    });
    connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
}

std::optional<LineAddress> AddressDialog::address() const {
    const auto parsed = parseLineAddress(where_->text());
    return parsed ? std::optional(*parsed) : std::nullopt;
}

}  // namespace skincal
