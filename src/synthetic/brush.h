// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "synthetic/random.h"

namespace dxslam::brush {

// The strokes that all painters share. Images are CV_8UC3, BGR.

/// Sum of octaves of smooth random fields, CV_32FC1, about -1 to 1. The coarsest has cells_x by
/// cells_y cells; each further octave has twice as many and `gain` times the strength. Repeats
/// seamlessly.
cv::Mat fractal_noise(Random& random, cv::Size size, int cells_x, int cells_y, int octaves,
                      double gain = 0.55);

/// Adds noise (CV_32FC1) times strength (grey levels) to all channels.
void add_noise(cv::Mat& image, const cv::Mat& noise, double strength);

/// Multiplies the image by 1 + noise * strength.
void modulate(cv::Mat& image, const cv::Mat& noise, double strength);

/// A colour of given saturation (0 to 1) and value (0 to 255); hue in [0, 1).
cv::Scalar color_of(double hue, double saturation, double value);
cv::Scalar random_color(Random& random, double min_value = 40, double max_value = 230);
cv::Scalar jitter(Random& random, const cv::Scalar& color, double amount);

/// A random word of capitals, small letters or digits.
std::string random_word(Random& random, int min_length, int max_length);

/// A word whose capitals are `height` pixels high, with its lower left corner at `origin`.
void write_word(cv::Mat& image, const std::string& word, cv::Point origin, double height,
                const cv::Scalar& color, Random& random);

/// Lines of small print that fill the area; line height in pixels.
void write_lines(cv::Mat& image, cv::Rect area, double line_height, const cv::Scalar& color,
                 Random& random);

/// One random filled shape (ellipse, polygon, ring, rectangle, star) within the area.
void draw_shape(cv::Mat& image, cv::Rect area, const cv::Scalar& color, Random& random);

/// A landscape or a skyline that fills the area.
void draw_landscape(cv::Mat& image, cv::Rect area, Random& random);
void draw_skyline(cv::Mat& image, cv::Rect area, Random& random);

/// Linear blend from one colour to another across the area in a random direction.
void fill_gradient(cv::Mat& image, cv::Rect area, const cv::Scalar& from, const cv::Scalar& to,
                   Random& random);

}  // namespace dxslam::brush
