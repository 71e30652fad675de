#include "core/skin/module_template.h"

#include <algorithm>

namespace skincal {

double ModuleTemplate::portRadius() const {
    double radius = 0;
    for (const Vector3d& port : ports)
        radius = std::max(radius, port.norm());
    return radius;
}

ModuleTemplate paperHexagon() {
    ModuleTemplate hexagon;
    hexagon.name = "hex";
    // A regular hexagon of 30 mm across corners: its edges lie 0.9 mm inside the ports, half of the gap between boards.
    hexagon.outline = {{0.015, 0.0},  {0.0075, 0.01299},   {-0.0075, 0.01299},
                       {-0.015, 0.0}, {-0.0075, -0.01299}, {0.0075, -0.01299}};
    hexagon.led = {0.0079, 0, 0};
    hexagon.ports = {{0.012, 0.007, 0}, {0.012, -0.007, 0}, {-0.012, 0.007, 0}, {-0.012, -0.007, 0}};
    hexagon.accelerometer = Vector3d::Zero();
    hexagon.sensors = {{"proximity", {0, 0, 0}},
                       {"force", {0.0045, 0.0075, 0}},
                       {"force", {0.0045, -0.0075, 0}},
                       {"force", {-0.009, 0, 0}},
                       {"temperature", {-0.004, 0.004, 0}}};
    return hexagon;
}

ModuleTemplate triangleTemplate() {
    ModuleTemplate triangle;
    triangle.name = "triangle";
    triangle.outline = {{0.016, 0.0}, {-0.008, 0.013856}, {-0.008, -0.013856}};
    triangle.led = {0.005, 0, 0};
    // The middles of the edges, half a millimetre out: 60, 180 and 300 degrees.
    triangle.ports = {{0.00425, 0.007361, 0}, {-0.0085, 0, 0}, {0.00425, -0.007361, 0}};
    triangle.accelerometer = Vector3d::Zero();
    triangle.sensors = {{"force", {0, 0, 0}}};
    return triangle;
}

ModuleTemplate rectangleTemplate() {
    ModuleTemplate rectangle;
    rectangle.name = "rectangle";
    rectangle.outline = {{0.015, 0.01}, {-0.015, 0.01}, {-0.015, -0.01}, {0.015, -0.01}};
    rectangle.led = {0.010, 0.004, 0};
    rectangle.ports = {{0.0155, 0, 0}, {0, 0.0105, 0}, {-0.0155, 0, 0}, {0, -0.0105, 0}};
    rectangle.accelerometer = Vector3d::Zero();
    rectangle.sensors = {{"force", {-0.007, 0, 0}}, {"force", {0.007, 0, 0}}};
    return rectangle;
}

}  // namespace skincal
