#include "ui/scene3d/picture.h"

#include <fmt/format.h>
#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkPNGWriter.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "ui/scene3d/body_scene.h"

namespace skincal {
namespace {

void addText(vtkRenderer& renderer, const std::string& text, int size, double x, double y,
             const std::array<double, 3>& colour, bool bold = false) {
    auto actor = vtkSmartPointer<vtkTextActor>::New();
    actor->SetInput(text.c_str());
    actor->GetTextProperty()->SetFontFamilyToArial();
    actor->GetTextProperty()->SetFontSize(size);
    actor->GetTextProperty()->SetBold(bold ? 1 : 0);
    actor->GetTextProperty()->SetColor(colour[0], colour[1], colour[2]);
    actor->SetPosition(x, y);
    renderer.AddActor2D(actor);
}

std::array<double, 3> softInk(const PictureOptions& options) {
    return options.dark ? std::array{0.66, 0.69, 0.73} : std::array{0.38, 0.41, 0.46};
}

int textSize(const PictureOptions& options) {
    return std::max(12, options.height / 45);
}

void addLegend(vtkRenderer& renderer, const BodyModel& body, const PictureOptions& options) {
    const std::array<double, 3> ink = options.dark ? std::array{0.92, 0.93, 0.95} : std::array{0.13, 0.14, 0.17};
    const std::array<double, 3> soft = softInk(options);
    const int size = textSize(options);
    const double step = 1.5 * size;
    const double left = 1.6 * size;
    double y = options.height - 2.6 * size;
    addText(renderer, fmt::format("{} of {} modules placed", body.quality.modulesPlaced, body.quality.modulesTotal),
            size + 4, left, y, ink, true);
    constexpr std::size_t kMaxPatches = 12;
    y -= 1.4 * step;
    for (std::size_t k = 0; k < std::min(kMaxPatches, body.patches.size()); ++k, y -= step) {
        const BodyPatch& patch = body.patches[k];
        addText(renderer,
                fmt::format("patch {}: {} module{}{}", patch.id.value, patch.modules.size(),
                            patch.modules.size() == 1 ? "" : "s", patch.T_body_patch ? "" : ", not placed"),
                size, left, y, patchColour(patch.id), true);
    }
    if (body.patches.size() > kMaxPatches)
        addText(renderer, fmt::format("and {} more", body.patches.size() - kMaxPatches), size, left, y, soft);
    std::string figures;
    if (body.quality.residual_rms_px)
        figures += fmt::format("pixel residual {:.3f} px   ", *body.quality.residual_rms_px);
    if (body.quality.link_mismatch_rms)
        figures += fmt::format("link mismatch {:.2f} mm   ", *body.quality.link_mismatch_rms * 1e3);
    addText(renderer, figures + fmt::format("method {}", body.generator.method), size, left, 1.4 * size, soft);
    if (body.quality.trust == Trust::NotToBeTrusted)
        addText(renderer, "not to be trusted", size, left, 3.0 * size, {0.80, 0.13, 0.10}, true);
}

/// A bar of a round length (1, 2 or 5 times a power of ten), at most a sixth of the picture's width.
void addScaleBar(vtkRenderer& renderer, double metresPerPixel, const PictureOptions& options) {
    const double longest = metresPerPixel * options.width / 6;
    double length = std::pow(10, std::floor(std::log10(longest)));
    for (const double factor : {5.0, 2.0}) {
        if (length * factor <= longest) {
            length *= factor;
            break;
        }
    }
    const std::array<double, 3> soft = softInk(options);
    const int size = textSize(options);
    const double right = options.width - 1.6 * size;
    const double left = right - length / metresPerPixel;
    const double y = 3.4 * size;
    auto points = vtkSmartPointer<vtkPoints>::New();
    auto lines = vtkSmartPointer<vtkCellArray>::New();
    lines->InsertNextCell(4);
    for (const auto& [px, py] : {std::pair{left, y + 0.4 * size}, {left, y}, {right, y}, {right, y + 0.4 * size}})
        lines->InsertCellPoint(points->InsertNextPoint(px, py, 0));
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(points);
    data->SetLines(lines);
    auto mapper = vtkSmartPointer<vtkPolyDataMapper2D>::New();
    mapper->SetInputData(data);
    auto bar = vtkSmartPointer<vtkActor2D>::New();
    bar->SetMapper(mapper);
    bar->GetProperty()->SetColor(soft[0], soft[1], soft[2]);
    bar->GetProperty()->SetLineWidth(2);
    renderer.AddActor2D(bar);
    addText(renderer, fmt::format("{:g} mm", 1e3 * length), size, left, y + 0.8 * size, soft);
}

}  // namespace

tl::expected<std::string, std::string> drawPicture(const BodyModel& body, const PictureOptions& options) {
    if (!options.validate())
        throw std::logic_error("PictureOptions out of range");
    const char* display = std::getenv("DISPLAY");
    if (display == nullptr || *display == '\0')
        return tl::unexpected<std::string>("there is no X display to draw with: run under xvfb-run, or install xvfb");
    auto renderer = vtkSmartPointer<vtkRenderer>::New();
    if (options.dark) {
        renderer->SetBackground(0.10, 0.11, 0.13);
        renderer->SetBackground2(0.16, 0.18, 0.21);
    } else {
        renderer->SetBackground(0.93, 0.94, 0.96);
        renderer->SetBackground2(1, 1, 1);
    }
    renderer->GradientBackgroundOn();
    addBody(*renderer, body);
    // Room for the legend on the left and for a line below.
    const double margin = 9.0 * textSize(options) / options.width;
    const Margins margins{margin, 0.03, 0.04, 5.0 * textSize(options) / options.height};
    const double height = lookAtBody(*renderer, body, margins, static_cast<double>(options.width) / options.height);
    addLegend(*renderer, body, options);
    addScaleBar(*renderer, height / options.height, options);

    auto window = vtkSmartPointer<vtkRenderWindow>::New();
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(8);
    window->SetSize(options.width, options.height);
    window->AddRenderer(renderer);
    window->Render();

    auto image = vtkSmartPointer<vtkWindowToImageFilter>::New();
    image->SetInput(window);
    image->ReadFrontBufferOff();
    auto writer = vtkSmartPointer<vtkPNGWriter>::New();
    writer->WriteToMemoryOn();
    writer->SetInputConnection(image->GetOutputPort());
    writer->Write();
    vtkUnsignedCharArray* bytes = writer->GetResult();
    if (bytes == nullptr || bytes->GetNumberOfValues() == 0)
        return tl::unexpected<std::string>("the picture could not be drawn");
    return std::string(reinterpret_cast<const char*>(bytes->GetPointer(0)),
                       static_cast<std::size_t>(bytes->GetNumberOfValues()));
}

}  // namespace skincal
