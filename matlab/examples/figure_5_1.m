% FIGURE_5_1  Build the model of the thesis' figure 5.1: send rotor speeds, record odometry.
%
% This script needs Simulink and ROS Toolbox and is untested. Start the vehicle with
%
%   roslaunch quadcore quadrotor.launch gui:=false world:=empty z:=10 lockstep:=true
%
% The model sends the workspace variable `commands` ([t w1 w2 w3 w4], rad/s) step by step, and writes
% the messages into `odometry.mat`.
model = 'figure_5_1';
step = 1e-3;  % s, step of the plant
if ~exist('commands', 'var')
  commands = [0, 480, -480, 480, -480];
end
new_system(model);
open_system(model);
set_param(model, 'SolverType', 'Fixed-step', 'Solver', 'FixedStepDiscrete', ...
          'FixedStep', num2str(step), 'StopTime', '10');
add = @(library, name, varargin) add_block(library, [model, '/', name], varargin{:});

add('simulink/Sources/From Workspace', 'speeds', 'VariableName', 'commands', ...
    'SampleTime', num2str(step), 'Interpolate', 'off', 'OutputAfterFinalValue', 'Holding final value');
add('robotlib/Blank Message', 'empty', 'entityType', 'std_msgs/Float64MultiArray', ...
    'SampleTime', num2str(step));
add('simulink/Signal Routing/Bus Assignment', 'message', 'AssignedSignals', 'Data');
add('robotlib/Publish', 'vel_cmd', 'topicSource', 'Specify your own', ...
    'topic', '/quadrotor/vel_cmd', 'messageType', 'std_msgs/Float64MultiArray');
add_line(model, 'empty/1', 'message/1');
add_line(model, 'speeds/1', 'message/2');
add_line(model, 'message/1', 'vel_cmd/1');

add('robotlib/Subscribe', 'odom', 'topicSource', 'Specify your own', 'topic', '/odom', ...
    'messageType', 'nav_msgs/Odometry', 'sampleTime', num2str(step));
add('simulink/Signal Routing/Bus Selector', 'state', 'OutputSignals', ...
    ['Pose.Pose.Position.X,Pose.Pose.Position.Y,Pose.Pose.Position.Z,', ...
     'Twist.Twist.Linear.X,Twist.Twist.Linear.Y,Twist.Twist.Linear.Z']);
add('simulink/Signal Routing/Mux', 'row', 'Inputs', '6');
add('simulink/Sinks/To File', 'kept', 'Filename', 'odometry.mat', 'MatrixName', 'odometry', ...
    'SaveFormat', 'Array');
add_line(model, 'odom/2', 'state/1');
for i = 1:6
  add_line(model, sprintf('state/%d', i), sprintf('row/%d', i));
end
add_line(model, 'row/1', 'kept/1');
save_system(model);
