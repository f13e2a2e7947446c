// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/poses.h"

#include <gtest/gtest.h>

#include "vantage/base/error.h"

namespace vantage {
namespace {

/// A quarter turn about the third axis.
const Eigen::Quaterniond kTurn(Eigen::AngleAxisd(0.5 * 3.14159265358979323846, Eigen::Vector3d::UnitZ()));
constexpr const char* kMatrix = "0 -1 0 1 1 0 0 2 0 0 1 3";
constexpr const char* kW = "0.70710678118654752";

std::string many(const std::string& first) { return first + "\n" + first + "\n"; }

TEST(Poses, TheSamePoseInEveryForm) {
  const std::string w = kW;
  const std::string forms[] = {
      many(kMatrix),
      many("7 " + std::string(kMatrix)),
      many(std::string(kMatrix) + " 0 0 0 1"),
      "0 -1 0 1\n1 0 0 2\n0 0 1 3\n0 0 0 1\n",
      many("1,2,3," + w + ",0,0," + w),
      many("17.5 1 2 3 0 0 " + w + " " + w),
      "# from somewhere\nname,x,y,z,qw,qx,qy,qz\nfirst,1,2,3," + w + ",0,0," + w + "\n",
      "tx,ty,tz,r00,r01,r02,r10,r11,r12,r20,r21,r22\r\n1,2,3,0,-1,0,1,0,0,0,0,1\r\n",
      "frame,m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23\n000005,0,-1,0,1,1,0,0,2,0,0,1,3",
      "id,x,y,z,qw,qx,qy,qz,remark\n4,1,2,3," + w + ",0,0," + w + ",fine\n",
  };
  for (const std::string& form : forms) {
    const std::vector<FilePose> poses = parse_poses(form, "p.txt");
    ASSERT_FALSE(poses.empty()) << form;
    for (const FilePose& pose : poses) {
      EXPECT_EQ(pose.position, Vec<3>(1.0, 2.0, 3.0)) << form;
      ASSERT_TRUE(pose.orientation) << form;
      EXPECT_LT(pose.orientation->angularDistance(kTurn), 1e-9) << form;
    }
  }
  EXPECT_EQ(parse_poses(forms[6], "").front().name, "first");
  EXPECT_EQ(parse_poses(forms[8], "").front().name, "000005");
  EXPECT_EQ(parse_poses(many("1 2 3"), "").size(), 2U);
  EXPECT_FALSE(parse_poses(many("hall 1 2 3"), "").front().orientation);
  EXPECT_EQ(parse_poses(many("hall 1 2 3"), "").front().name, "hall");
}

TEST(Poses, WhatIsNoneIsRefusedWithItsLine) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "p.txt"},
      {"# nothing\n", "p.txt"},
      {"x,y,z\n", "no poses"},
      {"1 2\n", "p.txt:1"},
      {"1 2 3\n1 2\n", "p.txt:2"},
      {"1 2 3\n1 2 three\n", "p.txt:2"},
      {"1 2 nan\n", "p.txt:1"},
      {"1 2 1e999\n", "p.txt:1"},
      {"1 0 0 0 0 1 0 0 0 0 2 0\n", "no rotation"},
      {"1 0 0 0 0 1 0 0 0 0 -1 0\n", "no rotation"},
      {"1,2,3,0.5,0,0,0\n", "quaternion"},
      {"x,y,z,qw,qx,qy\n1,2,3,1,0,0\n", "part of a rotation"},
      {"x,y\n1,2\n", "columns"},
  };
  for (const auto& [text, says] : cases) {
    try {
      static_cast<void>(parse_poses(text, "p.txt"));
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << text << " -> " << error.what();
    }
  }
}

}  // namespace
}  // namespace vantage
