// bench_network MODEL ROWS COLUMNS COUNT: seconds for so many runs of a network by OpenCV, without
// anything around it.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <opencv2/dnn.hpp>

int main(int argc, char** argv) {
    if (argc != 5) return EXIT_FAILURE;
    cv::dnn::Net net = cv::dnn::readNetFromONNX(argv[1]);
    net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    const int shape[] = {1, 3, std::atoi(argv[2]), std::atoi(argv[3])};
    cv::Mat blob(4, shape, CV_32F);
    cv::randu(blob, -1, 1);
    const auto run = [&] {
        net.setInput(blob);
        return net.forward().total();
    };
    std::size_t elements = run();
    const auto begin = std::chrono::steady_clock::now();
    for (int i = std::atoi(argv[4]); i > 0; --i) elements += run();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    std::printf("%.6f\n", taken.count());
    return elements > 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
