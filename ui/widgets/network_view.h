#pragma once

#include <QWidget>
#include <optional>
#include <set>

#include "ui/presenters/network_layout.h"

namespace skincal {

struct Theme;

/// The network laid flat: boards in the colours of their patches, ports as dots, cables as dashed arcs. A module is
/// chosen by a click, or by keys: arrows go from one to the next, Return or Space does what a click does.
class NetworkView : public QWidget {
    Q_OBJECT
  public:
    explicit NetworkView(QWidget* parent = nullptr);

    void setNetwork(FlatNetwork network);
    /// Those that the operator should look at.
    void setFaulty(std::set<ModuleId> modules);
    void setSelected(std::optional<ModuleId> module);
    /// Its LED shines.
    void setLit(std::optional<ModuleId> module);
    void setPlaceholder(const QString& text);

    [[nodiscard]] QPointF toWidget(const QPointF& mm) const { return transform().map(mm); }
    [[nodiscard]] const FlatNetwork& network() const { return network_; }
    /// Where the keys are.
    [[nodiscard]] std::optional<ModuleId> current() const { return current_; }

    [[nodiscard]] QSize sizeHint() const override { return {560, 300}; }
    [[nodiscard]] QSize minimumSizeHint() const override { return {240, 160}; }

  signals:
    void moduleClicked(skincal::ModuleId module);

  protected:
    void paintEvent(QPaintEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    bool event(QEvent* event) override;

  private:
    [[nodiscard]] QTransform transform() const;
    void setCurrent(std::optional<ModuleId> module);
    void paintModules(QPainter& painter, const Theme& theme) const;
    void paintCables(QPainter& painter, const Theme& theme) const;
    [[nodiscard]] const FlatModule* moduleAt(const QPointF& position) const;

    FlatNetwork network_;
    std::set<ModuleId> faulty_;
    std::optional<ModuleId> selected_, lit_, current_;
    QString placeholder_;
};

}  // namespace skincal
