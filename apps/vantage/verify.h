// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <span>

#include "vantage/audit/certificate.h"
#include "vantage/session/result.h"

/// Exit code of `reconstruct --verify` when the certificate is wrong: 1, as programs that compare have it.
inline constexpr int kWrongCertificate = 1;

/// Shows how far a verification is, on a terminal's stderr; asks the signal handler whether to stop.
class VerifyProgress final : public vantage::Observer {
 public:
  explicit VerifyProgress(bool quiet);
  ~VerifyProgress() override;
  void stage(std::string_view name) override;
  [[nodiscard]] bool stop_requested() override;

 private:
  bool live_;
};

/// The `verify` object of `reconstruct --json`.
[[nodiscard]] vantage::Json to_json(const vantage::CertificateReport& report);
/// "verified: …" in two lines, and one a fault.
[[nodiscard]] std::string verify_text(const vantage::CertificateReport& report);
