// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/materials.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "synthetic/brush.h"

namespace dxslam {
namespace {

using brush::color_of;
using brush::fractal_noise;
using brush::jitter;

cv::Mat canvas(cv::Size size, const cv::Scalar& color) { return {size, CV_8UC3, color}; }

// Draws `draw` at every wrapped position that touches the image, so that the material repeats.
template <class Draw>
void wrapped(cv::Size size, cv::Point at, int reach, const Draw& draw) {
  for (const int dx : {-size.width, 0, size.width}) {
    for (const int dy : {-size.height, 0, size.height}) {
      const cv::Point p(at.x + dx, at.y + dy);
      if (p.x > -reach && p.y > -reach && p.x < size.width + reach && p.y < size.height + reach) {
        draw(p);
      }
    }
  }
}

// Small dark or light marks: chips, holes, stains, drips. They are what makes a plain wall
// distinct.
void add_marks(cv::Mat& image, Random& random, int count, double contrast, int max_radius) {
  for (int i = 0; i < count; ++i) {
    const cv::Point at(random.integer(image.cols), random.integer(image.rows));
    const cv::Vec3b& under = image.at<cv::Vec3b>(at);
    const double shift = random.uniform(0.4, 1.0) * (random.chance(0.65) ? -contrast : contrast);
    const cv::Scalar color(under[0] + shift, under[1] + shift, under[2] + shift);
    const double size = random.uniform();
    const int radius = 1 + static_cast<int>(size * size * max_radius);
    const cv::Size axes(radius, std::max(1, static_cast<int>(radius * random.uniform(0.3, 1.0))));
    const double turn = random.uniform(0, 180);
    wrapped(image.size(), at, radius + 2, [&](cv::Point p) {
      cv::ellipse(image, p, axes, turn, 0, 360, color, cv::FILLED, cv::LINE_AA);
    });
  }
}

void add_cracks(cv::Mat& image, Random& random, int count, double contrast) {
  for (int i = 0; i < count; ++i) {
    cv::Point2d p(random.uniform(0, image.cols), random.uniform(0, image.rows));
    double heading = random.uniform(0, 6.28);
    const int pieces = random.integer(4, 14);
    for (int k = 0; k < pieces; ++k) {
      heading += random.normal() * 0.5;
      const cv::Point2d q =
          p + random.uniform(8, 26) * cv::Point2d(std::cos(heading), std::sin(heading));
      const cv::Point inside(std::clamp(static_cast<int>(p.x), 0, image.cols - 1),
                             std::clamp(static_cast<int>(p.y), 0, image.rows - 1));
      const cv::Vec3b& under = image.at<cv::Vec3b>(inside);
      const cv::Scalar color(under[0] - contrast, under[1] - contrast, under[2] - contrast);
      cv::line(image, p, q, color, 1 + (k < pieces / 3), cv::LINE_AA);
      p = q;
    }
  }
}

cv::Mat paint_plaster(Random& random, cv::Size size) {
  cv::Mat image = canvas(
      size, color_of(random.uniform(), random.uniform(0.05, 0.35), random.uniform(165, 225)));
  cv::Mat blotches = fractal_noise(random, size, 6, 6, 6, 0.7);
  brush::modulate(image, blotches, 0.08);
  cv::Mat sponge;
  cv::threshold(fractal_noise(random, size, 24, 24, 4, 0.7), sponge, random.uniform(0.35, 0.6), 1.0,
                cv::THRESH_BINARY);
  cv::GaussianBlur(sponge, sponge, {3, 3}, 0);
  brush::add_noise(image, sponge, random.chance(0.5) ? -26 : 22);
  brush::add_noise(image, fractal_noise(random, size, 256, 256, 2, 0.9), 7);
  add_marks(image, random, 260, 60, 7);
  add_cracks(image, random, 14, 55);
  return image;
}

cv::Mat paint_masonry(Random& random, cv::Size size, int rows, double length,
                      const cv::Scalar& base, const cv::Scalar& mortar, double variation) {
  cv::Mat image = canvas(size, mortar);
  brush::add_noise(image, fractal_noise(random, size, 200, 200, 2, 0.8), 12);
  for (int row = 0; row < rows; ++row) {
    const int top = size.height * row / rows + 2, bottom = size.height * (row + 1) / rows - 2;
    const int first = random.integer(static_cast<int>(size.width / 8.0));
    int x = first;
    while (x < first + size.width) {
      const int width = static_cast<int>((bottom - top) * length * random.uniform(0.8, 1.25));
      int end = x + width;
      if (first + size.width - end < width / 2) end = first + size.width;
      const cv::Scalar color = jitter(random, base, variation);
      wrapped(size, {x, top}, size.width, [&](cv::Point p) {
        if (p.y != top) return;
        cv::rectangle(image, {p.x + 2, top}, {p.x + end - x - 3, bottom}, color, cv::FILLED);
        cv::line(image, {p.x + 3, bottom}, {p.x + end - x - 3, bottom}, color * 0.7, 1);
      });
      x = end;
    }
  }
  brush::modulate(image, fractal_noise(random, size, 32, 32, 5, 0.75), 0.13);
  add_marks(image, random, 500, 55, 6);
  return image;
}

cv::Mat paint_brick(Random& random, cv::Size size) {
  const cv::Scalar base =
      color_of(random.uniform(0.0, 0.09), random.uniform(0.35, 0.65), random.uniform(130, 190));
  return paint_masonry(random, size, 30, 2.8, base, color_of(0.1, 0.08, random.uniform(150, 200)),
                       42);
}

cv::Mat paint_stone(Random& random, cv::Size size) {
  const cv::Scalar base =
      color_of(random.uniform(0.05, 0.6), random.uniform(0.03, 0.2), random.uniform(120, 180));
  return paint_masonry(random, size, 11, 1.7, base, color_of(0.1, 0.05, random.uniform(80, 200)),
                       36);
}

void add_grain(cv::Mat image, Random& random, double strength) {
  brush::modulate(
      image, fractal_noise(random, image.size(), 2, std::max(4, image.rows / 6), 4, 0.8), strength);
  const int knots = random.integer(3);
  for (int i = 0; i < knots && image.rows > 12; ++i) {
    const cv::Point at(random.integer(image.cols), random.integer(image.rows));
    const int radius = random.integer(3, std::max(4, image.rows / 6));
    const cv::Vec3b& under = image.at<cv::Vec3b>(at);
    const cv::Scalar color(under[0] * 0.55, under[1] * 0.55, under[2] * 0.55);
    for (int ring = radius; ring > 0; ring -= 3) {
      cv::ellipse(image, at, {ring * 2, ring}, 0, 0, 360, color, 1 + ring / 6, cv::LINE_AA);
    }
  }
}

cv::Mat paint_planks(Random& random, cv::Size size) {
  cv::Mat image = canvas(size, {30, 40, 50});
  const cv::Scalar base =
      color_of(random.uniform(0.05, 0.1), random.uniform(0.35, 0.6), random.uniform(120, 195));
  const int rows = 16;
  for (int row = 0; row < rows; ++row) {
    const int top = size.height * row / rows, bottom = size.height * (row + 1) / rows;
    int x = 0;
    while (x < size.width) {
      int end = x + random.integer(size.width / 5, size.width / 2);
      if (size.width - end < size.width / 8) end = size.width;
      cv::Mat plank = image(cv::Rect(x + 1, top + 1, end - x - 2, bottom - top - 2));
      plank.setTo(jitter(random, base, 34));
      add_grain(plank, random, 0.14);
      x = end;
    }
  }
  add_marks(image, random, 160, 45, 4);
  return image;
}

cv::Mat paint_wood(Random& random, cv::Size size) {
  cv::Mat image = canvas(size, color_of(random.uniform(0.04, 0.11), random.uniform(0.3, 0.65),
                                        random.uniform(90, 200)));
  for (int k = 0; k < 4; ++k) {
    add_grain(image(cv::Rect(0, size.height * k / 4, size.width, size.height / 4)), random, 0.17);
  }
  add_marks(image, random, 150, 40, 5);
  add_cracks(image, random, 6, 35);
  return image;
}

cv::Mat paint_tiles(Random& random, cv::Size size) {
  const cv::Scalar first = brush::random_color(random, 130, 215);
  const cv::Scalar second =
      random.chance(0.5) ? first * random.uniform(0.5, 0.8) : brush::random_color(random, 90, 200);
  cv::Mat image = canvas(size, color_of(0.1, 0.05, random.uniform(70, 210)));
  const int count = 8;
  const int side = size.width / count;
  for (int row = 0; row < count; ++row) {
    for (int col = 0; col < count; ++col) {
      cv::Mat tile = image(cv::Rect(col * side + 1, row * side + 1, side - 3, side - 3));
      tile.setTo(jitter(random, (row + col) % 2 == 0 ? first : second, 16));
      brush::modulate(tile, fractal_noise(random, tile.size(), 3, 3, 5, 0.75), 0.1);
      if (random.chance(0.25)) {
        const cv::Scalar ink = jitter(random, second * 0.6, 30);
        for (int k = 0; k < 3; ++k) {
          brush::draw_shape(tile, {side / 4, side / 4, side / 2, side / 2}, jitter(random, ink, 40),
                            random);
        }
      }
    }
  }
  add_marks(image, random, 350, 45, 5);
  return image;
}

cv::Mat paint_mosaic(Random& random, cv::Size size) {
  cv::Mat image = canvas(size, {150, 155, 160});
  const int count = 64;
  const int side = size.width / count;
  const cv::Scalar palette[3] = {brush::random_color(random, 90, 220),
                                 brush::random_color(random, 90, 220),
                                 brush::random_color(random, 60, 220)};
  const cv::Mat zones = fractal_noise(random, {count, count}, 6, 6, 3, 0.8);
  for (int row = 0; row < count; ++row) {
    for (int col = 0; col < count; ++col) {
      const float zone = zones.at<float>(row, col);
      const cv::Scalar& color = palette[zone < -0.2F ? 0 : zone < 0.3F ? 1 : 2];
      cv::rectangle(image, {col * side + 1, row * side + 1},
                    {(col + 1) * side - 2, (row + 1) * side - 2}, jitter(random, color, 30),
                    cv::FILLED);
    }
  }
  brush::modulate(image, fractal_noise(random, size, 16, 16, 5), 0.06);
  return image;
}

cv::Mat paint_carpet(Random& random, cv::Size size) {
  cv::Mat image =
      canvas(size, color_of(random.uniform(), random.uniform(0.15, 0.5), random.uniform(80, 150)));
  brush::modulate(image, fractal_noise(random, size, 5, 5, 4), 0.08);
  brush::add_noise(image, fractal_noise(random, size, 300, 300, 2, 0.9), 20);
  add_marks(image, random, 2200, 55, 3);
  add_marks(image, random, 120, 35, 12);
  return image;
}

cv::Mat paint_ceiling(Random& random, cv::Size size) {
  cv::Mat image = canvas(size, color_of(0.12, random.uniform(0.0, 0.08), random.uniform(205, 232)));
  brush::modulate(image, fractal_noise(random, size, 8, 8, 5), 0.03);
  add_marks(image, random, 5200, 95, 2);
  add_marks(image, random, 50, 40, 14);
  const int count = 4;
  for (int i = 0; i < count; ++i) {
    const int at = size.width * i / count;
    cv::line(image, {at, 0}, {at, size.height}, {150, 150, 150}, 3);
    cv::line(image, {0, at}, {size.width, at}, {165, 165, 165}, 3);
  }
  return image;
}

cv::Mat paint_concrete(Random& random, cv::Size size) {
  cv::Mat image =
      canvas(size, color_of(random.uniform(), random.uniform(0.0, 0.1), random.uniform(120, 175)));
  brush::modulate(image, fractal_noise(random, size, 5, 5, 7, 0.7), 0.16);
  brush::add_noise(image, fractal_noise(random, size, 300, 300, 2, 0.9), 9);
  add_marks(image, random, 900, 60, 6);
  add_cracks(image, random, 24, 60);
  return image;
}

cv::Mat paint_fabric(Random& random, cv::Size size) {
  const cv::Scalar base = brush::random_color(random, 70, 200),
                   stripe = brush::random_color(random, 60, 220);
  cv::Mat image = canvas(size, base);
  const int style = random.integer(3);
  if (style < 2) {
    const int count = random.integer(14, 30);
    for (int i = 0; i < count; ++i) {
      const int at = size.width * i / count, width = random.integer(3, size.width / count - 2);
      cv::rectangle(image, {at, 0}, {at + width, size.height}, jitter(random, stripe, 25),
                    cv::FILLED);
      if (style == 1) {
        cv::Mat band = image(cv::Rect(0, at, size.width, std::min(width, size.height - at)));
        cv::addWeighted(band, 0.55, cv::Mat(band.size(), CV_8UC3, stripe), 0.45, 0, band);
      }
    }
  } else {
    for (int i = 0; i < 260; ++i) {
      const cv::Point at(random.integer(size.width - 60), random.integer(size.height - 60));
      brush::draw_shape(image, {at.x, at.y, 60, 60}, jitter(random, stripe, 40), random);
    }
  }
  brush::add_noise(image, fractal_noise(random, size, 256, 256, 2, 0.9), 12);
  brush::modulate(image, fractal_noise(random, size, 5, 5, 4), 0.1);
  return image;
}

cv::Mat paint_metal(Random& random, cv::Size size) {
  cv::Mat image = canvas(
      size, color_of(random.uniform(0.5, 0.7), random.uniform(0.02, 0.3), random.uniform(90, 190)));
  brush::modulate(image, fractal_noise(random, size, 3, 60, 4, 0.8), 0.05);
  add_marks(image, random, 300, 50, 4);
  add_cracks(image, random, 30, 40);
  return image;
}

cv::Mat paint_wallpaper(Random& random, cv::Size size) {
  const cv::Scalar base =
      color_of(random.uniform(), random.uniform(0.1, 0.35), random.uniform(160, 220));
  cv::Mat image = canvas(size, base);
  const cv::Scalar inks[3] = {jitter(random, base * 0.6, 40), brush::random_color(random, 80, 200),
                              jitter(random, base * 1.15, 20)};
  // Hand-printed: every motif differs a little, so that it can be told from its neighbours.
  for (int i = 0; i < 420; ++i) {
    const int reach = random.integer(26, 80);
    const cv::Point at(random.integer(size.width - reach), random.integer(size.height - reach));
    brush::draw_shape(image, {at.x, at.y, reach, reach},
                      jitter(random, inks[random.integer(3)], 22), random);
  }
  brush::modulate(image, fractal_noise(random, size, 6, 6, 6, 0.7), 0.07);
  add_marks(image, random, 200, 45, 6);
  return image;
}

}  // namespace

cv::Mat paint_material(Pattern pattern, Random& random, cv::Size size) {
  switch (pattern) {
    case Pattern::kPlaster:
      return paint_plaster(random, size);
    case Pattern::kBrick:
      return paint_brick(random, size);
    case Pattern::kStone:
      return paint_stone(random, size);
    case Pattern::kPlanks:
      return paint_planks(random, size);
    case Pattern::kWood:
      return paint_wood(random, size);
    case Pattern::kTiles:
      return paint_tiles(random, size);
    case Pattern::kMosaic:
      return paint_mosaic(random, size);
    case Pattern::kCarpet:
      return paint_carpet(random, size);
    case Pattern::kCeiling:
      return paint_ceiling(random, size);
    case Pattern::kConcrete:
      return paint_concrete(random, size);
    case Pattern::kFabric:
      return paint_fabric(random, size);
    case Pattern::kMetal:
      return paint_metal(random, size);
    case Pattern::kWallpaper:
      return paint_wallpaper(random, size);
    default:
      return {};
  }
}

}  // namespace dxslam
