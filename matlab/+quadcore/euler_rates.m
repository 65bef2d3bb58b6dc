function [W, dW] = euler_rates(rpy, rates)
% EULER_RATES  W of thesis eq. (2.9), which makes the rates of roll, pitch and yaw an angular velocity
% in body axes, and its derivative by time when the angles have these rates.
  s = sin(rpy); c = cos(rpy);
  W = [1, 0, -s(2); 0, c(1), s(1) * c(2); 0, -s(1), c(1) * c(2)];
  if nargout > 1
    dW = [0, 0, -c(2) * rates(2); ...
          0, -s(1) * rates(1), c(1) * c(2) * rates(1) - s(1) * s(2) * rates(2); ...
          0, -c(1) * rates(1), -s(1) * c(2) * rates(1) - c(1) * s(2) * rates(2)];
  end
end
