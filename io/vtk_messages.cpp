#include "io/vtk_messages.h"

#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>
#include <vtkStringOutputWindow.h>

namespace couture::io {

struct VtkMessages::Capture {
    vtkSmartPointer<vtkOutputWindow> previous = vtkOutputWindow::GetInstance();
    vtkNew<vtkStringOutputWindow> window;
};

VtkMessages::VtkMessages() : capture_(std::make_unique<Capture>()) {
    vtkOutputWindow::SetInstance(capture_->window);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
}

VtkMessages::~VtkMessages() {
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_INFO);
    vtkOutputWindow::SetInstance(capture_->previous);
}

bool VtkMessages::has_any() const { return !capture_->window->GetOutput().empty(); }

std::string VtkMessages::first() const {
    // "ERROR: In FILE, line N\nCLASS (ADDRESS): MESSAGE\n\n"
    const std::string all = capture_->window->GetOutput();
    const std::size_t start = all.find("): ");
    if (start == std::string::npos) {
        return "nothing";
    }
    const std::string text = all.substr(start + 3, all.find("\n\n", start) - start - 3);
    return text.substr(0, text.find_last_not_of(" \n\t.") + 1);
}

}  // namespace couture::io
