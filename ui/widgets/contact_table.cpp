#include "ui/widgets/contact_table.h"

#include <QHeaderView>
#include <QKeyEvent>
#include <QLabel>
#include <QLocale>
#include <QVBoxLayout>

namespace skincal {
namespace {

constexpr int kColumns = 8;

QString numberOf(double value, int digits) {
    QLocale locale;
    locale.setNumberOptions(QLocale::OmitGroupSeparator);
    return locale.toString(value, 'f', digits);
}

std::array<QString, kColumns> textsOf(const TouchContact& contact) {
    std::array<QString, kColumns> texts{QString::number(contact.module.value), numberOf(contact.force, 2)};
    if (!contact.position_r || !contact.normal_r) {
        texts[2] = ContactTable::tr("not placed");
        return texts;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        texts.at(2 + i) = numberOf(1e3 * (*contact.position_r)[axis], 1);
        texts.at(5 + i) = numberOf((*contact.normal_r)[axis], 2);
    }
    return texts;
}

}  // namespace

ContactTable::ContactTable(QWidget* parent)
    : QTableWidget(static_cast<int>(kMostContacts), kColumns, parent),
      nothing_(new QLabel(tr("Nothing presses on the skin."))) {
    setHorizontalHeaderLabels(
        {tr("Module"), tr("Force (N)"), tr("x (mm)"), tr("y (mm)"), tr("z (mm)"), tr("Normal x"), tr("y"), tr("z")});
    verticalHeader()->hide();
    verticalHeader()->setDefaultSectionSize(fontMetrics().height() + 8);
    horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
    horizontalHeader()->setDefaultAlignment(Qt::AlignRight | Qt::AlignVCenter);
    setStyleSheet(QStringLiteral("QTableView { padding-right: 8px; }"));
    setEditTriggers(QAbstractItemView::NoEditTriggers);
    setSelectionMode(QAbstractItemView::NoSelection);
    setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    setShowGrid(false);
    for (int row = 0; row < rowCount(); ++row) {
        for (int column = 0; column < columnCount(); ++column) {
            auto* item = new QTableWidgetItem;
            item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
            setItem(row, column, item);
        }
    }
    setFixedHeight(rowCount() * verticalHeader()->defaultSectionSize() + horizontalHeader()->sizeHint().height() + 8);
    nothing_->setProperty("muted", true);
    nothing_->setAlignment(Qt::AlignCenter);
    (new QVBoxLayout(viewport()))->addWidget(nothing_);
    setTabKeyNavigation(false);
    connect(this, &QTableWidget::cellClicked, this, &ContactTable::choose);
}

void ContactTable::choose(int row) {
    if (row >= 0 && static_cast<std::size_t>(row) < shown_.size())
        emit moduleClicked(shown_[static_cast<std::size_t>(row)]);
}

void ContactTable::keyPressEvent(QKeyEvent* event) {
    const int key = event->key();
    // Not its signal "activated", which a double click gives as well.
    if (key == Qt::Key_Return || key == Qt::Key_Enter || key == Qt::Key_Space)
        choose(currentRow());
    else
        QTableWidget::keyPressEvent(event);
}

void ContactTable::setContacts(const std::vector<TouchContact>& contacts) {
    shown_.clear();
    for (int row = 0; row < rowCount(); ++row) {
        std::array<QString, kColumns> texts;
        if (const auto i = static_cast<std::size_t>(row); i < contacts.size()) {
            texts = textsOf(contacts[i]);
            shown_.push_back(contacts[i].module);
        }
        for (int column = 0; column < columnCount(); ++column)
            item(row, column)->setText(texts.at(static_cast<std::size_t>(column)));
    }
    nothing_->setVisible(contacts.empty());
}

}  // namespace skincal
