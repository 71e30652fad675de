#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "core/formats/file_error.h"
#include "core/vision/camera_model.h"

namespace skincal {

/// Reads a calibrated camera from what other programs write. What it is shows from its content, never from its name:
///   ROS camera_info, as camera_calibration saves it (image_width, camera_matrix, distortion_model, …) or as a message
///     printed on a terminal (width, K or k, D or d);
///   OpenCV's FileStorage, YAML or XML: camera_matrix and distortion_coefficients as !!opencv-matrix, image_width,
///     image_height; also Camera_Matrix, Distortion_Coefficients, image_Width, image_Height of older samples and
///     cameraMatrix, distCoeffs; fisheye_model 1 means four coefficients of cv::fisheye;
///   Kalibr's camchain: cam0 with camera_model pinhole, intrinsics, distortion_model radtan, equidistant or none,
///     resolution.
///
/// Distortion: plumb_bob (radtan) of 4 or 5 numbers, rational_polynomial of 8, equidistant (fisheye) of 4. OpenCV's
/// longer rational models (12, 14) pass where their thin prisms and tilts are zero. No numbers mean no distortion.
/// All of these count pixels as we do: (0, 0) is the centre of the top-left pixel.
///
/// One error names file, place (key, or line and column) and what was expected, for: no such file; more than 1 MB; what
/// is neither YAML nor XML, nests too deep, holds aliases or a key twice; an unknown kind of file; a missing size,
/// matrix or coefficients; numbers that aren't finite or out of range; a matrix of another shape, with skew, or of an
/// uncalibrated camera; camera models other than pinhole (omni, eucm, ds, …) and distortions other than these (fov, …);
/// binning or a region of interest; several cameras where `camera` names none.
/// @param camera  which one of a camchain's cameras, e.g. "cam1"; may be empty where there is one only.
[[nodiscard]] tl::expected<CameraModel, FileError> readCameraModel(const std::filesystem::path& file,
                                                                   const std::string& camera = {});

/// The same from bytes; `file` is for messages.
[[nodiscard]] tl::expected<CameraModel, FileError> parseCameraModel(std::string_view bytes,
                                                                    const std::filesystem::path& file,
                                                                    const std::string& camera = {});

/// ROS camera_info YAML that parseCameraModel reads back to the same bits; a camera without distortion has an empty
/// list of coefficients. `name` becomes camera_name: letters, digits and _ only, anything else becomes _.
[[nodiscard]] std::string cameraModelToYaml(const CameraModel& camera, std::string_view name = "camera");

/// Writes cameraModelToYaml atomically. Refuses as writeFileAtomically does.
[[nodiscard]] tl::expected<void, FileError> writeCameraModel(const std::filesystem::path& file,
                                                             const CameraModel& camera,
                                                             std::string_view name = "camera");

}  // namespace skincal
