// A host that uses Qt SerialPort, as the AI programs with a Qt window do. See ask.h.
#include <QCoreApplication>
#include <QSerialPort>

#include "tests/clients/ask.h"

int main(int count, char** words) {
  const QCoreApplication application(count, words);
  unsigned char request[kMostBytes];
  const int size = count == 4 ? bytes_of(words[2], request) : -1;
  if (size < 0) return fail("DEVICE HEX COUNT");
  QSerialPort port(QString::fromLocal8Bit(words[1]));
  port.setBaudRate(QSerialPort::Baud115200);
  if (!port.open(QIODevice::ReadWrite)) return fail(qPrintable(port.errorString()));
  for (int left = std::atoi(words[3]); left > 0; --left) {
    port.write(reinterpret_cast<const char*>(request), size);
    for (char byte = 1; byte != 0;) {
      if (port.bytesAvailable() == 0 && !port.waitForReadyRead(kDeadline_ms)) return fail("no answer");
      if (port.read(&byte, 1) != 1) return fail(qPrintable(port.errorString()));
      std::printf("%02x", static_cast<unsigned char>(byte));
    }
    std::printf("\n");
  }
  return 0;
}
