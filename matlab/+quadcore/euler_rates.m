function [W, dW] = euler_rates(rpy, rates)
% EULER_RATES  Return the matrix W from rates of roll, pitch and yaw to the angular velocity.
%
%   W = quadcore.euler_rates(rpy)
%   [W, dW] = quadcore.euler_rates(rpy, rates)
%
% The angular velocity is in body axes; thesis eq. (2.9). dW is the time derivative of W at these rates.
  s = sin(rpy); c = cos(rpy);
  W = [1, 0, -s(2); 0, c(1), s(1) * c(2); 0, -s(1), c(1) * c(2)];
  if nargout > 1
    dW = [0, 0, -c(2) * rates(2); ...
          0, -s(1) * rates(1), c(1) * c(2) * rates(1) - s(1) * s(2) * rates(2); ...
          0, -c(1) * rates(1), -s(1) * c(2) * rates(1) - c(1) * s(2) * rates(2)];
  end
end
